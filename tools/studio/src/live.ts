// A match that runs: watched as a spectator, or played in.
import { Body } from "../../web/src/body.js";
import { Client, type SessionEvent } from "../../web/src/client.js";
import type { Hit } from "../../web/src/queries.js";
import type { Recording } from "../../web/src/recording.js";
import { Chart } from "./charts.js";
import { Controls } from "./controls.js";
import { Facts, button, make, saveFile, section, toggle } from "./dom.js";
import type { Engine } from "./engine.js";
import { LiveStage } from "./live_stage.js";
import type { Mode } from "./mode.js";
import { type Colouring, painterOf } from "./paint.js";
import { Diorama, type Picture } from "./picture.js";
import { NEAR, bodyOfPlayer } from "./players.js";
import { Selection } from "./selection.js";
import type { Live } from "./session.js";
import { showSection } from "./show.js";

const PUMP_MS = 4; // between looks at the network
const PREDICTED = 8; // ticks that a player's page runs ahead
const SEATS = 64, SERVER = 253;
const CHAT = 1; // first byte of a command: tools/arena/arena_command.h
const BOT_SEED = 1n;
const MOST_LINES = 200;
const FACTS = ["server", "seat", "state", "tick", "place", "players", "waits for", "lead", "jitter buffer", "late inputs", "rollbacks", "islands again", "states loaded"] as const;
/** Events that a person reads, as sentences. */
const LINES: Partial<Record<SessionEvent["kind"], string>> = {
  started: "the match runs", joined: "joined", silent: "is silent", "player active": "plays", "state loaded": "a state was loaded",
  paused: "paused, or goes on", desync: "desync", finished: "the match is over", "command refused": "a command was refused",
};

type Role = "spectator" | "player";

interface Connected {
  stage: LiveStage;
  /** Of all ticks that the client steps. */
  recording: Recording;
}

/** A client of the match that has a world. */
async function connect(engine: Engine, live: Live, role: Role): Promise<Connected> {
  const client = new Client(engine.lockstone, {
    url: live.url, token: live.token ?? undefined, name: live.name, ...(role === "spectator" ? { slot: role } : { predictionTicks: PREDICTED }),
  });
  let recording: Recording | null = null;
  try {
    while (recording === null || client.ticks === 0) {
      client.update();
      if (client.world !== null) recording ??= client.record(); // before the first tick
      if (client.over) throw new Error(`${live.url}: ${client.state}: ${client.reason}`);
      await new Promise((done) => setTimeout(done, PUMP_MS));
    }
    return { stage: new LiveStage(engine, client), recording };
  } catch (error) {
    recording?.destroy();
    client.destroy();
    throw error;
  }
}

export class LiveView implements Mode {
  readonly panel = make("div");
  readonly lane = null;
  readonly labels = [];
  readonly shown = new Set<string>(["triggers", "sleeping"]);
  lead: LiveStage;
  dioramas: Diorama[] = [];
  private readonly selection = new Selection();
  private readonly facts = new Facts("live", FACTS);
  private readonly charts = {
    lead: new Chart("Lead", "ticks", "chart-lead"), received: new Chart("Received", "kB/s", "chart-received"),
    jitter: new Chart("Jitter buffer", "ms", "chart-jitter"), late: new Chart("Late inputs", "", "chart-late"), again: new Chart("Ticks again", "", "chart-again"),
    computed: new Chart("Islands again", "", "chart-computed"), recalled: new Chart("Remembered", "", "chart-recalled"),
  };
  private readonly lines = make("div", { class: "events", id: "live-events" });
  private readonly told = make("p", { id: "live-told", hidden: true });
  private readonly received: { at: number; bytes: number }[] = [];
  private readonly timer: ReturnType<typeof setInterval>;
  private controls: Controls | null = null;
  private recording: Recording | null = null;
  private bot = false;
  private own = 0n;
  private colour: Colouring = "body";
  private before = { again: 0, computed: 0, recalled: 0 }; // as the last tick found them
  private waiting = false; // for another seat

  static async open(engine: Engine, picture: Picture, live: Live): Promise<LiveView> {
    return new LiveView(engine, picture, live, await connect(engine, live, live.role));
  }

  private constructor(private readonly engine: Engine, private readonly picture: Picture, private readonly live: Live, connected: Connected) {
    this.lead = connected.stage;
    this.buildPanel();
    this.take(connected);
    this.timer = setInterval(() => this.pump(), PUMP_MS);
  }

  step(): void {}
  seek(): void {}

  get fraction(): number {
    return this.lead.fraction;
  }

  refresh(): void {
    const { lead: { client, tick }, charts } = this;
    for (const chart of Object.values(charts)) chart.draw(client.ticks, client.ticks);
    const { stats } = client;
    const names = Array.from({ length: SEATS }, (_, slot) => client.playerName(slot)).map((name, slot) => (name ? `${slot} ${name}` : ""));
    const waiting = client.waitingMask;
    const awaited = Array.from({ length: SEATS }, (_, slot) => slot).filter((slot) => (waiting >> BigInt(slot)) & 1n);
    this.facts.set("server", this.live.url);
    this.facts.set("seat", this.plays ? `player ${client.slot}` : "spectator");
    this.facts.set("state", client.paused ? "paused" : client.over ? `${client.state}: ${client.state === "finished" ? client.finishReason : client.reason}` : client.state);
    this.facts.set("tick", client.ticks === tick ? String(tick) : `${tick}, of them ${tick - client.ticks} guessed`);
    this.facts.set("players", names.filter((name) => name !== "").join(", "));
    this.facts.set("waits for", awaited.map((slot) => `player ${slot}`).join(", ") || "nobody");
    this.facts.set("lead", this.plays ? `${stats.marginQuarters / 4} ticks` : "–");
    this.facts.set("jitter buffer", `${stats.jitterMs.toFixed(1)} ms`);
    this.facts.set("late inputs", String(stats.substitutedInputs));
    this.facts.set("rollbacks", `${stats.rollbacks}, ${stats.ticksSteppedAgain} ticks again`);
    this.facts.set("islands again", `${stats.islandsComputedAgain} computed, ${stats.islandsRecalled} remembered`);
    this.facts.set("states loaded", String(stats.statesLoaded));
    this.selection.refresh(this.lead.world, this.picture.target);
    if (this.plays) this.followOwn();
  }

  choose(hit: Hit | null): void {
    this.selection.set(hit?.body.id ?? 0n);
  }

  destroy(): void {
    clearInterval(this.timer);
    this.drop();
  }

  private get plays(): boolean {
    return this.controls !== null;
  }

  /** Shows this stage, whose client plays or watches. */
  private take({ stage, recording }: Connected): void {
    this.lead = stage;
    this.recording = recording;
    const paint = painterOf(() => this.colour, () => this.shown.has("sleeping"), () => this.selection.row);
    this.dioramas = [new Diorama(stage, paint)];
    this.selection.set(0n);
    this.picture.frame(stage);
    this.controls = stage.client.slot < SEATS ? new Controls() : null;
    if (this.plays) this.picture.distance = NEAR;
    this.own = 0n;
    this.before = { again: 0, computed: 0, recalled: 0 };
    this.received.length = 0;
    this.tellRole();
  }

  private drop(): void {
    this.controls?.destroy();
    this.recording?.destroy();
    if (!this.lead.client.over) this.lead.client.leave();
    this.lead.destroy();
    for (const diorama of this.dioramas) diorama.dispose();
  }

  /** Takes another seat. The old one is left when the new one is there. */
  private async change(role: Role): Promise<void> {
    if (this.waiting) return;
    this.waiting = true;
    this.tell("Connecting …");
    try {
      const connected = await connect(this.engine, this.live, role);
      this.drop();
      this.take(connected);
      this.tell("");
    } catch (error) {
      this.tell(error instanceof Error ? error.message : String(error));
    }
    this.waiting = false;
  }

  private pump(): void {
    const { client } = this.lead;
    if (client.over) return;
    if (this.controls) {
      const input = this.bot ? client.botInput(BOT_SEED) : this.controls.bytes(this.picture.turn);
      if (input) client.setInput(input);
    }
    const before = this.lead.tick;
    for (const event of client.update()) this.hear(event);
    if (this.lead.tick !== before) this.lead.follow();
  }

  private hear(event: SessionEvent): void {
    if (event.kind === "tick") this.measure(event.tick + 1);
    const { client } = this.lead;
    const who = event.slot === SERVER ? "server" : event.slot < SEATS ? client.playerName(event.slot) || `player ${event.slot}` : "";
    if (event.kind === "command" && event.bytes[0] === CHAT) this.write(event.tick, `${who}: ${new TextDecoder().decode(event.bytes.subarray(1))}`);
    if (event.kind === "finished") this.recording?.finish(client.finishReason ?? "stopped");
    const line = LINES[event.kind];
    if (line) this.write(event.tick, [who, line, event.text].filter((text) => text !== "").join(" "));
  }

  private measure(tick: number): void {
    const { stats } = this.lead.client;
    const { lead, received, jitter, late } = this.charts;
    const at = performance.now();
    this.received.push({ at, bytes: stats.bytesReceived });
    while (this.received.length > 2 && this.received[0]!.at < at - 1000) this.received.shift();
    const first = this.received[0]!;
    if (at > first.at) received.series.set(tick, (stats.bytesReceived - first.bytes) / (at - first.at));
    if (this.plays) lead.series.set(tick, stats.marginQuarters / 4);
    jitter.series.set(tick, stats.jitterMs);
    late.series.set(tick, stats.substitutedInputs);
    const now = { again: stats.ticksSteppedAgain, computed: stats.islandsComputedAgain, recalled: stats.islandsRecalled };
    for (const name of ["again", "computed", "recalled"] as const) this.charts[name].series.set(tick, now[name] - this.before[name]);
    this.before = now;
  }

  private write(tick: number, text: string): void {
    this.lines.append(make("div", {}, `${tick}  ${text}`));
    if (this.lines.childElementCount > MOST_LINES) this.lines.firstElementChild?.remove();
    this.lines.scrollTop = this.lines.scrollHeight;
  }

  private followOwn(): void {
    const { world, client } = this.lead;
    if (this.own === 0n || !new Body(world, this.own).exists) {
      this.own = bodyOfPlayer(world, client.slot);
    }
    const row = this.own === 0n ? -1 : new Body(world, this.own).index;
    const { positions } = this.lead.view;
    if (row < 0) return;
    this.picture.target.fromArray(positions, 3 * row);
    this.facts.set("place", `${positions[3 * row]!.toFixed(1)}, ${positions[3 * row + 2]!.toFixed(1)} m`);
  }

  private tell(text: string): void {
    this.told.textContent = text;
    this.told.hidden = text === "";
  }

  private tellRole(): void {
    for (const [id, on] of [["live-watch", !this.plays], ["live-play", this.plays]] as const) {
      (this.panel.querySelector(`#${id}`) ?? document.getElementById(id))?.setAttribute("aria-pressed", String(on));
    }
  }

  private save(): void {
    if (this.recording) saveFile("match.lks", new Blob([new Uint8Array(this.recording.bytes())]));
  }

  private chatOf(): HTMLElement {
    const line = make("input", { type: "text", id: "live-say", maxLength: 120, placeholder: "say something", autocomplete: "off" });
    line.setAttribute("aria-label", "Chat");
    line.onkeydown = ({ key }) => {
      const { client } = this.lead;
      if (key !== "Enter" || line.value === "" || !this.plays || client.state !== "running") return;
      client.sendCommand(new Uint8Array([CHAT, ...new TextEncoder().encode(line.value)]));
      line.value = "";
    };
    return line;
  }

  private buildPanel(): void {
    this.panel.append(
      section("Match", this.facts.element, make("div", { class: "row" },
        button("Watch", "Watch as a spectator", () => void this.change("spectator"), "live-watch"),
        button("Play", "Take a seat", () => void this.change("player"), "live-play"),
        button("Save log", "Save what this page saw as a log", () => this.save(), "live-save"),
        toggle("a bot plays for me", "live-bot", this.bot, (on) => (this.bot = on))), this.told,
      make("p", {}, "WASD, arrows or a stick: move. Space, E, F, X or the pad's buttons: jump, push, grab, snowball.")),
      section("Connection", make("div", { class: "charts" }, ...Object.values(this.charts).map((chart) => chart.element))),
      section("Events", this.lines, this.chatOf()),
      showSection(this.shown, this.colour, (colour) => (this.colour = colour)),
      this.selection.element);
  }
}
