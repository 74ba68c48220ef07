// A log: watched, scrubbed, and proved tick by tick.
import { Body } from "../../web/src/body.js";
import type { Hit } from "../../web/src/queries.js";
import { Facts, button, make, section, select } from "./dom.js";
import type { Engine } from "./engine.js";
import { LogFile, ORIGINS, inputText } from "./log_file.js";
import { LogLane } from "./log_lane.js";
import { LogStage, Proof } from "./log_stage.js";
import type { Mode } from "./mode.js";
import { type Colouring, painterOf } from "./paint.js";
import { Diorama, type Picture } from "./picture.js";
import { NEAR, bodyOfPlayer } from "./players.js";
import { type ProverNews, type ProverTask, SERIES } from "./prover.js";
import { Selection } from "./selection.js";
import { showSection } from "./show.js";

const STATE_EVERY = 15; // ticks: a scrub computes fewer
const WORK_MS = 40; // of a frame, to compute towards a tick
const NOBODY = "nobody";
const FACTS = ["game", "build", "match", "seed", "length", "players", "end"] as const;

export class LogView implements Mode {
  readonly panel = make("div");
  readonly lane: HTMLElement;
  readonly labels = [];
  readonly shown = new Set<string>(["triggers", "sleeping"]);
  readonly lead: LogStage;
  readonly dioramas: Diorama[];
  private readonly log: LogFile;
  private readonly timeline: LogLane;
  private readonly figures: Float32Array;
  private readonly selection = new Selection();
  private readonly inputs: Facts;
  private readonly worker: Worker;
  private task: ProverTask | null;
  private colour: Colouring = "body";
  private known = 0;
  private followed = -1; // the slot; -1: nobody's
  private readonly proof = make("p", { id: "proof" });

  constructor(engine: Engine, private readonly picture: Picture, bytes: Uint8Array, private readonly seekTo: (tick: number) => void) {
    this.log = new LogFile(engine, bytes);
    this.lead = new LogStage(engine, this.log);
    this.figures = new Float32Array(SERIES.length * this.log.ticks);
    const paint = painterOf(() => this.colour, () => this.shown.has("sleeping"), () => this.selection.row);
    this.dioramas = [new Diorama(this.lead, paint)];
    picture.frame(this.lead);
    this.timeline = new LogLane(this.log, this.lead.proofs, this.figures,
      (tick, moving) => seekTo(moving ? this.lead.cheapTick(tick) : tick));
    this.lane = this.timeline.canvas;
    this.inputs = new Facts("input", this.log.playerNames);
    this.buildPanel();
    this.worker = new Worker(new URL("prover.js", document.baseURI), { type: "module" });
    this.worker.onmessage = ({ data }: MessageEvent<ProverNews>) => this.hear(data);
    this.task = { module: engine.module, log: bytes, every: STATE_EVERY };
  }

  step(): void {
    this.lead.goal = null;
    this.lead.step();
  }

  seek(tick: number): void {
    this.lead.approach(tick);
  }

  get goal(): number | null {
    return this.lead.goal;
  }

  refresh(): void {
    const { lead, log } = this;
    if (this.task) this.worker.postMessage(this.task, [this.task.log.buffer]); // after the first picture, which it would delay
    this.task = null;
    lead.work(WORK_MS);
    this.timeline.draw(lead.tick, this.known);
    this.selection.refresh(lead.world, this.picture.target);
    if (this.followed >= 0) this.follow();
    this.tellProof();
    for (let slot = 0; slot < log.players && lead.tick < lead.last; ++slot) {
      const { origin, bytes } = log.inputOf(lead.tick, slot);
      this.inputs.set(`player ${slot}`, `${ORIGINS[origin] ?? "?"}  ${origin === 3 ? "" : inputText(log, bytes)}`);
    }
  }

  choose(hit: Hit | null): void {
    this.selection.set(hit?.body.id ?? 0n);
  }

  key(key: string): boolean {
    const { firstDifferent } = this.lead.proofs;
    if (key !== "n" || firstDifferent === null) return false;
    this.seekTo(firstDifferent + 1);
    return true;
  }

  destroy(): void {
    this.worker.terminate();
    this.lead.destroy();
    this.log.close();
    for (const diorama of this.dioramas) diorama.dispose();
    document.getElementById("proof-text")?.replaceChildren();
  }

  private hear({ from, same, figures, state }: ProverNews): void {
    same.forEach((one, i) => this.lead.proofs.mark(from + i, one === 1));
    this.figures.set(figures, SERIES.length * (from - this.log.startTick));
    this.known = from + same.length - this.log.startTick;
    this.lead.keep(from + same.length, state);
  }

  private follow(): void {
    const id = bodyOfPlayer(this.lead.world, this.followed);
    if (id !== 0n) this.picture.target.set(...new Body(this.lead.world, id).position);
  }

  private followOf(): HTMLElement | null {
    if (!this.log.isArena) return null;
    const names = this.log.playerNames;
    const follow = (name: string) => {
      this.followed = names.indexOf(name);
      if (this.followed >= 0) this.picture.distance = Math.min(this.picture.distance, NEAR);
    };
    return select("follow-player", [NOBODY, ...names], NOBODY, follow, "follow");
  }

  private tellProof(): void {
    const { proofs, tick } = this.lead;
    const { firstDifferent, proved } = proofs;
    const all = this.log.ticks;
    const text = firstDifferent !== null ? `tick ${firstDifferent} comes to another hash here`
      : proved === all ? `all ${all} ticks proved` : `${proved} of ${all} ticks proved`;
    if (this.proof.textContent !== text) this.proof.textContent = text;
    const badge = document.getElementById("proof-text")!;
    const verdict = tick === this.log.startTick ? Proof.unknown : proofs.of(tick - 1);
    badge.textContent = ["", "✓ as recorded", "✗ not as recorded"][verdict]!;
    badge.className = verdict === Proof.same ? "good" : verdict === Proof.different ? "bad" : "";
  }

  private factsOf(): HTMLElement {
    const { log } = this;
    const facts = new Facts("log", FACTS);
    const seconds = log.ticks / log.tickRate;
    facts.set("game", log.game);
    facts.set("build", log.build + (log.sameCanary ? "" : " – computes otherwise than this page"));
    facts.set("match", log.matchId.toString(16));
    facts.set("seed", String(log.seed));
    facts.set("length", `${log.ticks} ticks, ${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(1).padStart(4, "0")}`);
    facts.set("players", String(log.players));
    facts.set("end", log.complete ? log.end : `missing: ${log.damage || "the recorder was killed"}`);
    return facts.element;
  }

  private eventsOf(): HTMLElement {
    const list = make("div", { class: "events", id: "events" });
    for (const { tick, kind, slot, text } of this.log.events.slice(0, 500)) {
      const whose = slot === 255 ? "" : ` player ${slot}`;
      list.append(button(`${tick}  ${kind}${whose}: ${text}`, `Go to tick ${tick}`, () => this.seekTo(tick)));
    }
    return list;
  }

  private buildPanel(): void {
    const late = this.log.origins.reduce((sum, origin) => sum + (origin === 1 || origin === 2 ? 1 : 0), 0);
    this.panel.append(
      section("Log", this.factsOf(), this.proof),
      section("Inputs of the next tick", this.inputs.element, make("p", {}, `late in all: ${late}`), this.followOf()),
      section("Events", this.log.events.length > 0 ? this.eventsOf() : make("p", {}, "none")),
      showSection(this.shown, this.colour, (colour) => (this.colour = colour)),
      this.selection.element);
  }
}
