// Two runs of one match: where they part, both worlds side by side, and how the difference spreads.
import * as three from "three";
import { Body } from "../../web/src/body.js";
import type { Hit } from "../../web/src/queries.js";
import { Chart, type Scale } from "./charts.js";
import { Facts, button, make, section, toggle } from "./dom.js";
import type { Engine } from "./engine.js";
import { Infection } from "./infection.js";
import { LogFile } from "./log_file.js";
import { LogStage } from "./log_stage.js";
import type { Mode } from "./mode.js";
import type { Pin } from "./overlays.js";
import { differenceColor, differencePainter } from "./paint.js";
import { Diorama, type Picture } from "./picture.js";
import { Selection } from "./selection.js";
import { type Desync, type Session, bytesOf } from "./session.js";

const SPREAD_TICKS = 120; // that are compared beforehand
const LISTED = 12; // bodies
const MOST_PINS = 200;

interface Differing {
  row: number;
  metres: number;
  speed: number;
  degrees: number;
}

/** From a nanometre to a metre, by the logarithm. */
const BY_SIZE: Scale = { text: length, height: (metres) => (metres > 0 ? Math.max(Math.log10(metres), -10) : -10.5) };

function length(metres: number): string {
  if (Number.isNaN(metres)) return "–";
  const [unit, scale] = metres >= 1 ? ["m", 1] : metres >= 1e-3 ? ["mm", 1e3] : metres >= 1e-6 ? ["µm", 1e6] : ["nm", 1e9];
  return metres === 0 ? "0" : `${(metres * (scale as number)).toPrecision(3)} ${unit}`;
}

/** Where to look next, by the verdict. */
function nextStep({ stage, note = "" }: Desync): string {
  if (note.includes("bit flipped")) return "One flipped bit: suspect memory, or a write through a stale pointer. Verify the log on another machine.";
  if (note.includes("inputs of player")) return "The inputs differ: one side stepped with an input that the server did not confirm.";
  if (stage) return `Both states were equal before stage ${stage} of this tick: its code, or the compiler's, is the first to look at.`;
  return "Verify the log with the builds of both sides; where they differ, lockstone bisect LOG --with PROGRAM names the stage.";
}

export class DesyncView implements Mode {
  readonly panel = make("div");
  readonly lane = null;
  readonly shown = new Set<string>(["triggers"]);
  readonly labels: string[];
  private readonly beside: Diorama[];
  private readonly overlaid: Diorama[];
  private isOverlaid = false;
  private rows = new Float32Array();
  private comparedTick = -1;
  private readonly table = make("tbody", { id: "differing" });
  private readonly counted = new Chart("Differing bodies", "", "chart-differing", 300);
  private readonly farthest = new Chart("Farthest apart", BY_SIZE, "chart-farthest", 300);
  private readonly infection: Infection;
  private readonly selection = new Selection(true);
  private readonly status = make("p", { id: "compare-status" });

  private constructor(private readonly engine: Engine, private readonly picture: Picture, private readonly desync: Desync,
    readonly lead: LogStage, private readonly there: LogStage, names: string[], private readonly seekTo: (tick: number) => void) {
    this.labels = [`here: ${names[0] ?? ""}`, `there: ${names[1] ?? names[0] ?? ""}`];
    const paint = differencePainter(() => this.rows, () => this.selection.row);
    this.beside = [lead, there].map((stage) => new Diorama(stage, paint, () => this.pins(stage)));
    this.overlaid = [new Diorama(lead, paint, () => this.pins(lead), { stage: there, has: (row) => this.rows[4 * row] !== 0 })];
    picture.frame(lead);
    this.infection = new Infection(engine, (row) => this.look(row));
    this.buildPanel();
    if (desync.found) this.measureSpread();
    this.seek(desync.found ? this.shownTick : lead.first);
    const worst = this.listed()[0];
    if (worst) this.look(worst.row);
  }

  /** Both worlds beside each other, or one in the other. */
  get dioramas(): Diorama[] {
    return this.isOverlaid ? this.overlaid : this.beside;
  }

  static async open(engine: Engine, picture: Picture, { logs, desync }: Session, seekTo: (tick: number) => void): Promise<DesyncView> {
    if (!desync) throw new Error("The command found nothing to compare.");
    const bytes = await Promise.all(["log/0", "log/1"].map(bytesOf));
    const [here, there] = bytes.map((one) => new LogStage(engine, new LogFile(engine, one)));
    if (desync.has_states && desync.state_at !== undefined) {
      const states = await Promise.all(["state/here", "state/there"].map(bytesOf));
      here!.setAnchor(desync.state_at, states[0]!);
      there!.setAnchor(desync.state_at, states[1]!);
    }
    return new DesyncView(engine, picture, desync, here!, there!, logs, seekTo);
  }

  step(): void {
    this.lead.step();
    if (this.there.canStep) this.there.step();
    this.compare();
  }

  seek(tick: number): void {
    this.lead.seek(Math.min(tick, this.there.last));
    this.there.seek(this.lead.tick);
    this.compare();
  }

  refresh(): void {
    const { tick, last } = this.lead;
    this.counted.draw(tick, last);
    this.farthest.draw(tick, last);
    this.selection.refresh(this.lead.world, this.picture.target);
    [this.lead, this.there].forEach((stage, i) => {
      const label = document.querySelectorAll("#labels span")[i];
      if (label) label.textContent = `${this.labels[i]}  ${stage.hash}`;
    });
  }

  choose(hit: Hit | null): void {
    this.selection.set(hit?.body.id ?? 0n);
  }

  key(key: string): boolean {
    if (key === "o") document.getElementById("overlaid")?.click();
    if (key === "o") return true;
    if (key !== "n" || !this.desync.found) return false;
    this.seekTo(this.shownTick);
    return true;
  }

  destroy(): void {
    for (const stage of [this.lead, this.there]) {
      stage.destroy();
      stage.log.close();
    }
    for (const diorama of [...this.beside, ...this.overlaid]) diorama.dispose();
  }

  /** The first tick at which both states are known and differ. */
  private get shownTick(): number {
    return this.desync.state_at ?? this.desync.tick + 1;
  }

  private compare(): void {
    const { tick } = this.lead;
    if (tick === this.comparedTick) return;
    this.comparedTick = tick;
    const { rows, differing } = this.engine.compare(this.lead.world, this.there.world);
    this.rows = rows.slice();
    this.note(tick, this.listed(), differing);
    if (tick >= this.shownTick) this.infection.note(tick, [this.lead.world, this.there.world], this.listed().map(({ row }) => row).sort((a, b) => a - b));
    this.showTable(this.listed());
    const { desync } = this;
    const unknown = desync.found && tick > desync.tick && tick < this.shownTick;
    const same = this.lead.hash === this.there.hash;
    this.status.textContent = unknown ? `Tick ${tick}: the state there is not known before tick ${this.shownTick}`
      : differing > 0 ? `Tick ${tick}: ${differing} ${differing === 1 ? "body differs" : "bodies differ"}` : same ? `Tick ${tick}: both are equal, bit for bit`
        : `Tick ${tick}: the bodies are equal, contacts or joints are not`;
  }

  private listed(): Differing[] {
    const found: Differing[] = [];
    for (let row = 0; 4 * row < this.rows.length; ++row) {
      const [flags, metres, speed, degrees] = this.rows.subarray(4 * row, 4 * row + 4);
      if (flags) found.push({ row, metres: metres!, speed: speed!, degrees: degrees! });
    }
    return found.sort((a, b) => b.metres - a.metres || b.speed - a.speed);
  }

  private note(tick: number, listed: Differing[], differing: number): void {
    this.counted.series.set(tick, differing);
    this.farthest.series.set(tick, listed[0]?.metres ?? 0);
  }

  // Above each body that differs, in the colour of its difference.
  private pins(stage: LogStage): Pin[] {
    const { positions } = stage.view;
    return this.listed().filter(({ row }) => stage.view.bodies[row]).slice(0, MOST_PINS)
      .map(({ row, metres }) => ({ place: positions.subarray(3 * row, 3 * row + 3), color: differenceColor(metres, new three.Color()) }));
  }

  private measureSpread(): void {
    const until = Math.min(this.shownTick + SPREAD_TICKS, this.lead.last, this.there.last);
    this.seek(Math.max(this.desync.tick - 20, this.lead.first));
    while (this.lead.tick < until) this.step();
  }

  private showTable(listed: Differing[]): void {
    const color = new three.Color();
    this.table.replaceChildren(...listed.slice(0, LISTED).map(({ row, metres, speed, degrees }) => {
      const swatch = make("span", { class: "swatch" });
      swatch.style.background = `#${differenceColor(metres, color).getHexString(three.SRGBColorSpace)}`;
      const cells = [length(metres), `${length(speed)}/s`, `${degrees.toPrecision(2)}°`].map((text) => make("td", {}, text));
      return make("tr", { tabIndex: 0, onclick: () => this.look(row), onkeydown: ({ key }) => key === "Enter" && this.look(row) },
        make("td", {}, swatch, String(row)), ...cells);
    }));
  }

  private look(row: number): void {
    const id = this.lead.view.bodies[row] ?? 0n;
    this.selection.set(id);
    if (id === 0n) return;
    this.picture.target.set(...new Body(this.lead.world, id).position);
    this.picture.distance = Math.min(this.picture.distance, 1.2);
  }

  private verdict(): HTMLElement {
    const { desync } = this;
    if (!desync.found) return make("div", { class: "verdict good", id: "verdict" }, make("strong", {}, "No difference"));
    const facts = new Facts("desync", ["tick", "stage", "object", "field", "here", "there", "seen at"]);
    facts.set("tick", String(desync.tick));
    facts.set("stage", desync.stage || "–");
    facts.set("object", desync.store ? `${desync.store} ${desync.object}${desync.name ? ` “${desync.name}”` : ""}` : "–");
    facts.set("field", desync.field ?? "–");
    facts.set("here", desync.here ?? "–");
    facts.set("there", desync.there ?? "–");
    facts.set("seen at", desync.state_at === undefined ? "–" : `tick ${desync.state_at}`);
    return make("div", { class: "verdict", id: "verdict" }, make("strong", {}, `They part in tick ${desync.tick}`), facts.element,
      make("p", {}, desync.note ?? ""), make("p", { id: "next-step" }, nextStep(desync)));
  }

  private buildPanel(): void {
    const head = make("thead", {}, make("tr", {}, ...["body", "apart", "speed", "angle"].map((text) => make("th", {}, text))));
    this.panel.append(
      section("Verdict", this.verdict(), make("div", { class: "row" },
        button("Before", "The last tick that is equal", () => this.seekTo(this.desync.tick), "go-before"),
        button("First difference", "The first tick that differs (N)", () => this.seekTo(this.shownTick), "go-first"),
        toggle("overlaid: the world there is clear (O)", "overlaid", false, (on) => (this.isOverlaid = on)))),
      section("Bodies that differ", this.status, make("table", {}, head, this.table),
        make("p", {}, "yellow: nanometres, red: metres; grey: equal")),
      section("How it spreads", make("div", { class: "charts" }, this.counted.element, this.farthest.element),
        make("div", { class: "infection" }, this.infection.element),
        make("p", {}, "From which body each had it, by contact or joint; colours are islands.")),
      this.selection.element);
  }
}
