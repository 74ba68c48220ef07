import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import type { Lockstone } from "./load.js";
import { Recording } from "./recording.js";
import { Socket, type WebSocketClass } from "./socket.js";
import { hex } from "./units.js";
import { World } from "./world.js";

export type { WebSocketLike } from "./socket.js";

export interface ClientOptions {
  /** Of a server with `--ws`: "wss://game.example:9000/". */
  url: string;
  /** The text that `lockstone token issue` wrote. Without one the match is insecure. */
  token?: string;
  /** A seat, or "spectator". Any seat. */
  slot?: number | "spectator";
  /** Rollback: ticks that are stepped on guesses, 0 … 15. 0: lockstep. */
  predictionTicks?: number;
  /** At most 32 bytes of UTF-8; control characters become "?". */
  name?: string;
  /** `Client.rejoinKey` of a tab that was closed or reloaded: the same seat again. */
  rejoinKey?: bigint;
  /** ms: how long a lost connection is called again. 30,000; 0: never. */
  reconnectMs?: number;
  /** ms: so long the server may be silent before it counts as lost. 5,000. */
  dropMs?: number;
  /** Instead of the global one, which Node has from version 22 on. */
  WebSocket?: WebSocketClass;
}

const STATES = ["connecting", "handshaking", "lobby", "joining", "running", "finished", "refused", "failed"] as const;
export type ClientState = (typeof STATES)[number];
const FINISHES = ["completed", "stopped", "desync", "no players"] as const;
export type FinishReason = (typeof FINISHES)[number];
/** What a player may ask the server's owner for. */
export const Ask = { pause: c.LKS_ASK_PAUSE, resume: c.LKS_ASK_RESUME, vote: c.LKS_ASK_VOTE } as const;

const KINDS = {
  [c.LKS_SESSION_STARTED]: "started", [c.LKS_SESSION_TICK]: "tick", [c.LKS_SESSION_FINISHED]: "finished",
  [c.LKS_SESSION_DESYNC]: "desync", [c.LKS_SESSION_SILENT]: "silent", [c.LKS_SESSION_JOINED]: "joined",
  [c.LKS_SESSION_PLAYER_ACTIVE]: "player active", [c.LKS_SESSION_STATE_LOADED]: "state loaded",
  [c.LKS_SESSION_PAUSED]: "paused", [c.LKS_SESSION_INPUT_REPLACED]: "input replaced",
  [c.LKS_SESSION_NAMED]: "named", [c.LKS_SESSION_COMMAND]: "command",
  [c.LKS_SESSION_COMMAND_REFUSED]: "command refused", [c.LKS_SESSION_PREDICTED]: "predicted", [c.LKS_SESSION_ROLLED_BACK]: "rolled back",
} as const;

/** Fields that the kind does not use are 0 or empty; see `lockstone_c/sessions.h`. */
export interface SessionEvent {
  kind: (typeof KINDS)[keyof typeof KINDS] | "other";
  tick: number;
  slot: number;
  /** Of the state after the tick. */
  hash: string;
  otherHash: string;
  value: number;
  reason: number;
  /** Of `command`. */
  bytes: Uint8Array;
  /** For people: of `desync` the tick, stage, body and field; of `named` the name. */
  text: string;
}

/** Counters of a client, as `lockstone join --json` prints them. */
export interface ClientStats {
  bytesSent: number;
  bytesReceived: number;
  packetsSent: number;
  packetsReceived: number;
  /** How early the newest inputs came to the server, in quarters of a tick. */
  marginQuarters: number;
  /** ms: the depth of the jitter buffer, which is the 99th percentile of how late ticks come. */
  jitterMs: number;
  substitutedInputs: number;
  rollbacks: number;
  ticksSteppedAgain: number;
  /** In these ticks: islands that were computed again, */
  islandsComputedAgain: number;
  /** and islands whose results the history remembered. */
  islandsRecalled: number;
  statesLoaded: number;
}

const event = c.lks_session_event;
const TEXT_BYTES = 512;
const NAME_BYTES = 32;
const NO_BYTES = new Uint8Array(0);
const FIRST_PAUSE_MS = 250;
const LONGEST_PAUSE_MS = 4000;
const CALLS_OF_STRANGERS = 3;

function putDefinition(heap: Heap, options: ClientOptions): number {
  const at = heap.input;
  const def = c.lks_client_def;
  heap.check(heap.f.lks_client_def_init(at, def.$bytes));
  const slot = options.slot === "spectator" ? c.LKS_SPECTATOR_SLOT : options.slot;
  heap.putWord(at + def.insecure, options.token === undefined ? 1 : 0);
  if (slot !== undefined) heap.putWord(at + def.wanted_slot, slot);
  if (options.predictionTicks !== undefined) heap.putWord(at + def.prediction_ticks, options.predictionTicks);
  if (options.dropMs !== undefined) heap.i64[(at + def.drop_us) >>> 3] = BigInt(Math.round(1000 * options.dropMs));
  if (options.rejoinKey !== undefined) heap.u64[(at + def.rejoin_key) >>> 3] = options.rejoinKey;
  new TextEncoder().encodeInto(options.name ?? "browser", heap.u8.subarray(at + def.name, at + def.name + NAME_BYTES));
  return at;
}

/** When a lost connection is called again: soon, and later each time. */
class Redial {
  private lostAt = -1;
  private nextAt = -1;
  private calls = 0;

  constructor(private readonly limitMs: number) {}

  reset(): void {
    this.lostAt = this.nextAt = -1;
    this.calls = 0;
  }

  /** "wait", "call" or "give up". */
  at(nowMs: number, known: boolean): "wait" | "call" | "give up" {
    if (this.lostAt < 0) this.lostAt = nowMs;
    if (this.nextAt < 0) {
      const pause = Math.min(FIRST_PAUSE_MS * 2 ** this.calls++, LONGEST_PAUSE_MS);
      this.nextAt = nowMs + pause;
      if (this.nextAt - this.lostAt > this.limitMs || (!known && this.calls > CALLS_OF_STRANGERS)) return "give up";
    }
    if (nowMs < this.nextAt) return "wait";
    this.nextAt = -1;
    return "call";
  }
}

/**
 * A player, or a spectator, of a match that `lockstone serve --ws` hosts. Call `update` at least sixty
 * times a second: timers of hidden tabs are slower, those of a worker are not.
 */
export class Client {
  private readonly heap: Heap;
  private readonly socket: Socket;
  private readonly redial: Redial;
  private game = 0;
  private address = 0;
  private simulation = 0;
  private seen: World | null = null;
  private events = { room: 0, capacity: 256 };
  private given = false;

  /** Begins to connect. The built-in games alone are known: the arena and the scenes. */
  constructor(readonly lockstone: Lockstone, options: ClientOptions) {
    const { heap } = lockstone;
    this.heap = heap;
    const WebSocket = options.WebSocket ?? (globalThis as { WebSocket?: unknown }).WebSocket as WebSocketClass | undefined;
    if (WebSocket === undefined) throw new Error("there is no WebSocket: give one in the options");
    this.redial = new Redial(options.reconnectMs ?? 30_000);
    this.socket = new Socket(heap, options.url, options.token, WebSocket);
    this.events.room = heap.allocate(this.events.capacity * event.$bytes);
    heap.check(heap.f.lks_game_builtin(heap.output));
    this.game = heap.getWord(heap.output);
    const connection = this.socket.call();
    const def = putDefinition(heap, options);
    heap.check(heap.f.lks_client_create(def, this.game, this.socket.transport, connection, heap.output));
    this.address = heap.getWord(heap.output);
  }

  /** Does all that is due and returns the events since the last call. `nowMs` never runs backwards. */
  update(nowMs = performance.now()): SessionEvent[] {
    const { heap } = this;
    heap.check(heap.f.lks_client_update(this.address, BigInt(Math.round(nowMs * 1000))));
    this.socket.send();
    if (this.state === "running") this.redial.reset();
    if (this.mayReconnect && !this.given) this.comeBack(nowMs);
    return this.readEvents();
  }

  private comeBack(nowMs: number): void {
    const what = this.redial.at(nowMs, this.rejoinKey !== 0n);
    if (what === "give up") this.given = true;
    if (what !== "call") return;
    const connection = this.socket.call();
    this.heap.check(this.heap.f.lks_client_reconnect(this.address, connection));
  }

  /** The input of this player for each tick from here on, at most 64 bytes. */
  setInput(bytes: Uint8Array): void {
    const { heap } = this;
    if (bytes.length > 64) throw new RangeError("an input has at most 64 bytes");
    heap.u8.set(bytes, heap.input);
    heap.check(heap.f.lks_client_set_input(this.address, heap.input, bytes.length));
  }

  /**
   * Gives a command, 1 … 65,536 bytes: chat, a purchase. It comes back to everybody at a tick, as an event `command`.
   * Returns its number, which an event `command refused` names.
   */
  sendCommand(bytes: Uint8Array): number {
    const { heap } = this;
    const room = heap.allocate(Math.max(bytes.length, 1));
    heap.u8.set(bytes, room);
    const status = heap.f.lks_client_send_command(this.address, room, bytes.length, heap.output);
    heap.f.free(room);
    heap.check(status);
    return Number(heap.getId(heap.output));
  }

  /** The input that the bot of `lockstone join` would press now, in the arena; null while there is no match. */
  botInput(seed: bigint): Uint8Array | null {
    const { heap } = this;
    const simulation = this.simulationAddress();
    const slot = this.slot;
    if (simulation === 0 || slot >= c.LKS_SPECTATOR_SLOT) return null;
    heap.check(heap.f.lks_web_bot(simulation, seed, slot, heap.input, 64, heap.output));
    return heap.u8.slice(heap.input, heap.input + heap.getWord(heap.output));
  }

  get state(): ClientState {
    return STATES[this.view(c.lks_client_view.state)]!;
  }
  /** Whether nothing more will happen. */
  get over(): boolean {
    const { state } = this;
    return state === "finished" || ((state === "refused" || state === "failed") && (this.given || !this.mayReconnect));
  }
  get finishReason(): FinishReason {
    return FINISHES[this.view(c.lks_client_view.finish_reason)]!;
  }
  /** 255 before being seated, 254 of a spectator. */
  get slot(): number {
    return this.view(c.lks_client_view.slot);
  }
  /** Confirmed ones. */
  get ticks(): number {
    return Number(this.view64(c.lks_client_view.ticks_stepped));
  }
  /** Guessed ones included. */
  get ticksPredicted(): number {
    return Number(this.view64(c.lks_client_view.ticks_predicted));
  }
  /** Opens the same seat again, from another page too; 0n before being seated. */
  get rejoinKey(): bigint {
    return this.view64(c.lks_client_view.rejoin_key);
  }
  get paused(): boolean {
    return this.view(c.lks_client_view.paused) === 1;
  }
  /** Bit n: the match waits for slot n. */
  get waitingMask(): bigint {
    return this.view64(c.lks_client_view.waiting);
  }
  private get mayReconnect(): boolean {
    return this.view(c.lks_client_view.may_reconnect) === 1;
  }

  /** Why the client was refused or failed, for people; empty otherwise. */
  get reason(): string {
    const { heap } = this;
    heap.check(heap.f.lks_client_reason(this.address, heap.output, TEXT_BYTES));
    return heap.text(heap.output);
  }

  /** The name that a slot's player gave; kept after it left. */
  playerName(slot: number): string {
    const { heap } = this;
    heap.check(heap.f.lks_client_player_name(this.address, slot, heap.output, TEXT_BYTES));
    return heap.text(heap.output);
  }

  get stats(): ClientStats {
    const { heap } = this;
    const at = heap.output;
    const s = c.lks_session_stats;
    heap.putWord(at, s.$bytes);
    heap.check(heap.f.lks_client_stats(this.address, at));
    const number = (place: number) => Number(heap.getId(at + place));
    return {
      bytesSent: number(s.bytes_sent), bytesReceived: number(s.bytes_received), packetsSent: number(s.packets_sent),
      packetsReceived: number(s.packets_received), marginQuarters: heap.i32[(at + s.margin_quarters) >>> 2]!,
      jitterMs: number(s.jitter_us) / 1000, substitutedInputs: number(s.substituted_inputs), rollbacks: number(s.rollbacks),
      ticksSteppedAgain: number(s.ticks_stepped_again), islandsComputedAgain: number(s.islands_computed_again),
      islandsRecalled: number(s.islands_recalled), statesLoaded: number(s.states_loaded),
    };
  }

  /** The hash of the simulation as it stands: of a client that predicts, guesses included; null while there is none. */
  get hash(): string | null {
    const simulation = this.simulationAddress();
    if (simulation === 0) return null;
    this.heap.check(this.heap.f.lks_simulation_hash(simulation, this.heap.output));
    return hex(this.heap.getId(this.heap.output));
  }

  /** The world of the match, to look at and to draw; null while there is none. It takes no command. */
  get world(): World | null {
    if (this.seen !== null) return this.seen;
    const simulation = this.simulationAddress();
    if (simulation === 0) return null;
    this.heap.check(this.heap.f.lks_simulation_world(simulation, this.heap.output));
    return (this.seen = new World(this.lockstone, {}, this.heap.getWord(this.heap.output)));
  }

  /** Begins a log of this client's ticks, in the lobby or later: see `lks_client_record`. */
  record(): Recording {
    const { heap } = this;
    heap.check(heap.f.lks_recorder_def_init(heap.input, c.lks_recorder_def.$bytes));
    heap.check(heap.f.lks_client_record(this.address, heap.input, heap.output));
    return new Recording(heap, heap.getWord(heap.output));
  }

  /** Asks the server's owner: `Ask.pause`, `Ask.resume`, or a vote with the game's topic and choice. */
  ask(kind: number, topic = 0, choice = 0): void {
    this.heap.check(this.heap.f.lks_client_ask(this.address, kind, topic, choice));
  }

  leave(): void {
    this.given = true;
    this.heap.check(this.heap.f.lks_client_leave(this.address));
    this.socket.send();
  }

  /** For tests of the comparison of states: changes one bit of this tab's state. */
  flipForTests(): void {
    this.heap.check(this.heap.f.lks_web_flip(this.simulationAddress()));
  }

  /** Ends the connection and releases the memory. */
  destroy(): void {
    if (this.address === 0) return;
    const { f } = this.heap;
    this.seen?.destroy();
    f.lks_simulation_destroy(this.simulation);
    f.lks_client_destroy(this.address);
    this.socket.destroy();
    f.lks_game_destroy(this.game);
    f.free(this.events.room);
    this.address = this.simulation = 0;
  }

  // 0 while there is none.
  private simulationAddress(): number {
    const { heap } = this;
    if (this.simulation !== 0) return this.simulation;
    const status = heap.f.lks_client_simulation(this.address, heap.output);
    if (status === c.LKS_NOT_FOUND) return 0;
    heap.check(status);
    return (this.simulation = heap.getWord(heap.output));
  }

  private fetchView(): number {
    const { heap } = this;
    heap.putWord(heap.output, c.lks_client_view.$bytes);
    heap.check(heap.f.lks_client_get(this.address, heap.output));
    return heap.output;
  }
  private view(place: number): number {
    return this.heap.getWord(this.fetchView() + place);
  }
  private view64(place: number): bigint {
    return this.heap.getId(this.fetchView() + place);
  }

  private readEvents(): SessionEvent[] {
    const { heap, events } = this;
    const status = heap.f.lks_client_events(this.address, events.room, events.capacity, heap.output);
    const count = heap.getWord(heap.output);
    if (status !== c.LKS_BUFFER_TOO_SMALL) {
      heap.check(status);
      return Array.from({ length: count }, (_, index) => this.eventAt(index));
    }
    heap.f.free(events.room);
    events.capacity = 2 * count;
    events.room = heap.allocate(events.capacity * event.$bytes);
    return this.readEvents();
  }

  private commandAt(index: number, size: number): Uint8Array {
    const { heap } = this;
    const room = heap.allocate(size);
    heap.check(heap.f.lks_client_event_bytes(this.address, index, room, size, heap.output));
    const bytes = heap.u8.slice(room, room + size);
    heap.f.free(room);
    return bytes;
  }

  private eventAt(index: number): SessionEvent {
    const { heap } = this;
    const at = this.events.room + index * event.$bytes;
    const number = heap.getWord(at + event.kind);
    const kind = KINDS[number as keyof typeof KINDS] ?? "other";
    let text = "";
    if (number === c.LKS_SESSION_DESYNC || number === c.LKS_SESSION_NAMED || number === c.LKS_SESSION_FINISHED) {
      heap.check(heap.f.lks_client_event_text(this.address, index, heap.output, TEXT_BYTES));
      text = heap.text(heap.output);
    }
    const value = Number(heap.i64[(at + event.value) >>> 3]!);
    const bytes = number === c.LKS_SESSION_COMMAND ? this.commandAt(index, value) : NO_BYTES;
    return {
      kind, text, bytes, slot: heap.getWord(at + event.slot), tick: Number(heap.getId(at + event.tick)),
      hash: hex(heap.getId(at + event.hash)), otherHash: hex(heap.getId(at + event.other_hash)),
      value, reason: heap.getWord(at + event.reason),
    };
  }
}
