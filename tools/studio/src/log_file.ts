// A log in the module's memory.
import type { Engine } from "./engine.js";
import type { World } from "../../web/src/world.js";

export const Origin = { received: 0, repeated: 1, neutral: 2, absent: 3 } as const;
export const ORIGINS = ["received", "repeated", "neutral", "absent"] as const;
const EVENT_KINDS = ["event", "join", "leave", "substitution", "note", "name"];
const FACTS_BYTES = 88;

export interface LogEvent {
  tick: number;
  kind: string;
  /** 255: of no player. */
  slot: number;
  text: string;
}

export class LogFile {
  readonly seed: bigint;
  readonly matchId: bigint;
  readonly startTick: number;
  readonly ticks: number;
  readonly players: number;
  readonly inputBytes: number;
  readonly tickRate: number;
  readonly complete: boolean;
  readonly isArena: boolean;
  /** Whether this build computes the hash of a short scene that the log's build does. */
  readonly sameCanary: boolean;
  readonly game: string;
  readonly build: string;
  readonly end: string;
  readonly damage: string;
  readonly keyframes: number[];
  readonly events: LogEvent[];
  readonly hashes: BigUint64Array;
  readonly inputs: Uint8Array;
  readonly origins: Uint8Array;
  private readonly address: number;

  constructor(private readonly engine: Engine, bytes: Uint8Array) {
    const { heap, f } = engine;
    const room = heap.allocate(bytes.length);
    try {
      heap.u8.set(bytes, room);
      heap.check(f.lks_studio_log_open(room, bytes.length, heap.output));
    } finally {
      f.free(room);
    }
    this.address = heap.getWord(heap.output);
    heap.check(f.lks_studio_log_describe(this.address, heap.output));
    const words = heap.u32.slice(heap.output >>> 2, (heap.output + FACTS_BYTES) >>> 2);
    const word = (i: number) => words[4 + i]!; // behind two numbers of 64 bits
    [this.seed, this.matchId] = [heap.getId(heap.output), heap.getId(heap.output + 8)];
    [this.startTick, this.ticks, this.players, this.inputBytes] = [word(0), word(1), word(2), word(3)];
    [this.tickRate, this.complete, this.isArena, this.sameCanary] = [word(4), word(7) === 1, word(8) === 1, word(9) === 1];
    // Copies: the module's memory may grow and move.
    this.hashes = heap.u64.slice(word(10) >>> 3, (word(10) >>> 3) + this.ticks);
    this.inputs = heap.u8.slice(word(11), word(11) + this.ticks * this.players * this.inputBytes);
    this.origins = heap.u8.slice(word(12), word(12) + this.ticks * this.players);
    this.keyframes = Array.from(heap.u64.slice(word(13) >>> 3, (word(13) >>> 3) + word(5)), Number);
    this.events = Array.from({ length: word(6) }, (_, i) => {
      const [tick, kind, slot] = heap.u32.slice((word(14) >>> 2) + 3 * i, (word(14) >>> 2) + 3 * i + 3);
      return { tick: tick!, kind: EVENT_KINDS[kind!] ?? "event", slot: slot!, text: this.text(4, i) };
    });
    [this.game, this.build, this.end, this.damage] = [0, 1, 2, 3].map((which) => this.text(which).trim()) as [string, string, string, string];
  }

  get playerNames(): string[] {
    return Array.from({ length: this.players }, (_, slot) => `player ${slot}`);
  }

  get endTick(): number {
    return this.startTick + this.ticks;
  }

  /** The simulation at the start tick. */
  makeWorld(): World {
    const { heap, f } = this.engine;
    heap.check(f.lks_studio_log_world(this.address, heap.output));
    return this.engine.world(heap.getWord(heap.output));
  }

  /** Steps with the recorded inputs, without a look at the hash. */
  stepUnseen(world: World): void {
    this.engine.heap.check(this.engine.f.lks_studio_log_step(this.address, world.address, 0));
  }

  /** Steps with the recorded inputs; whether the hash is the recorded one. */
  step(world: World): boolean {
    const { heap, f } = this.engine;
    heap.check(f.lks_studio_log_step(this.address, world.address, heap.output));
    return heap.getWord(heap.output) === 1;
  }

  loadKeyframe(world: World, index: number): void {
    this.engine.heap.check(this.engine.f.lks_studio_log_keyframe(this.address, index, world.address));
  }

  inputOf(tick: number, slot: number): { origin: number; bytes: Uint8Array } {
    const at = (tick - this.startTick) * this.players + slot;
    return { origin: this.origins[at] ?? Origin.absent, bytes: this.inputs.subarray(at * this.inputBytes, (at + 1) * this.inputBytes) };
  }

  close(): void {
    this.engine.f.lks_studio_log_close(this.address);
  }

  private text(which: number, index = 0): string {
    const { heap, f } = this.engine;
    heap.check(f.lks_studio_log_text(this.address, which, index, heap.output, 1000));
    return heap.text(heap.output);
  }
}

const BUTTONS = ["jump", "push", "grab", "shoot", "ride"];

/** An input in words: of the arena by its fields, of others as bytes. */
export function inputText(log: LogFile, bytes: Uint8Array): string {
  if (!log.isArena || bytes.length < 8) return Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join(" ");
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const [x, z, yaw] = [view.getInt8(0), view.getInt8(1), view.getInt16(2, true)];
  const pressed = BUTTONS.filter((_, i) => (bytes[4]! >> i) & 1).join(" ");
  return `move ${x} ${z}  aim ${Math.round((yaw * 360) / 65536)}°  ${pressed}`;
}
