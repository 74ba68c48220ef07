// The testbed: every built-in scene, to be played with.
import * as three from "three";
import * as c from "../../web/src/declarations.js";
import { Body, Motion } from "../../web/src/body.js";
import { type Hit, castRay } from "../../web/src/queries.js";
import { type Action, pull, push, remove, spawn } from "./action.js";
import { Chart } from "./charts.js";
import { Facts, button, make, section, select } from "./dom.js";
import type { Engine } from "./engine.js";
import { HashChart } from "./hash_chart.js";
import { type Seen, linkOf } from "./link.js";
import type { Mode } from "./mode.js";
import { OwnScene } from "./own_scene.js";
import { COLOURINGS, type Colouring, painterOf } from "./paint.js";
import { ParameterFields, type Values, valuesOf } from "./parameters.js";
import { Diorama, type Picture } from "./picture.js";
import { Selection } from "./selection.js";
import { SWITCHES, showSection } from "./show.js";
import { StageChart } from "./stage_chart.js";
import { TestbedStage } from "./testbed_stage.js";

const SHAPES = { box: c.LKS_BOX, ball: c.LKS_SPHERE, capsule: c.LKS_CAPSULE, cylinder: c.LKS_CYLINDER, cone: c.LKS_CONE, club: c.LKS_TAPERED_CAPSULE, die: c.LKS_ROUNDED_BOX } as const;
const COUNTS = ["bodies", "awake", "asleep", "contacts", "points", "islands", "joints"] as const;
const NAMES: Record<string, string> = { masses: "centre of mass", contacts: "contacts, forces" };
const THROW_SPEED = 20; // m/s

interface Held {
  body: bigint;
  /** In the frame of the body's shape. */
  point: three.Vector3;
  to: three.Vector3;
}

export class Testbed implements Mode {
  readonly panel = make("div", { class: "panel" });
  readonly lane = null;
  readonly labels = [];
  readonly shown: Set<string>;
  lead: TestbedStage;
  dioramas: Diorama[] = [];
  private readonly selection = new Selection();
  private readonly charts = {
    energy: new Chart("Energy", "J", "chart-energy"), contacts: new Chart("Contacts awake", "", "chart-contacts"),
    islands: new Chart("Islands", "", "chart-islands"), ms: new Chart("Tick time", "ms", "chart-ms"),
  };
  private readonly stages = new StageChart();
  private readonly hashes = new HashChart();
  private readonly parameters = new ParameterFields((values) => this.change(this.lead.name, this.lead.seed, values));
  private readonly counts = new Facts("count", COUNTS);
  private readonly told = make("p", { id: "told" });
  private colour: Colouring;
  /** Why the last file was refused. */
  private refused = "";
  private shape: keyof typeof SHAPES = "box";
  private held: Held | null = null;

  constructor(private readonly engine: Engine, private readonly picture: Picture, private readonly play: (on: boolean) => void, seen: Seen) {
    this.shown = new Set(seen.overlays.length > 0 ? seen.overlays : ["triggers", "sleeping"]);
    this.colour = COLOURINGS.find((name) => name === seen.colour) ?? "body";
    this.lead = this.open(seen.scene, seen.seed, seen.values);
    this.lead.replay(seen.journal, Math.min(seen.tick, 36_000), () => this.measure());
    if (seen.camera.length === 6) picture.pose = seen.camera;
    else if (seen.tick > 0) picture.frame(this.lead);
    this.buildPanel();
    this.measure();
  }

  step(): void {
    if (this.held) this.lead.act(this.pullOf(this.held));
    this.lead.step();
    this.measure();
  }

  seek(tick: number): void {
    this.lead.seek(tick);
  }

  refresh(wantsFigures: boolean): void {
    if (!wantsFigures) return;
    const { lead, charts } = this;
    for (const chart of Object.values(charts)) chart.draw(lead.tick, lead.last);
    this.stages.draw(lead.tick, lead.last);
    this.hashes.draw(lead.hashes, lead.tick, lead.last);
    const figures = lead.figures();
    for (const name of COUNTS) this.counts.set(name, String(figures[name]));
    this.selection.refresh(lead.world, this.picture.target);
    const told = this.refused || lead.refusal;
    this.told.textContent = told;
    this.told.hidden = told === "";
  }

  choose(hit: Hit | null): void {
    this.selection.set(hit?.body.id ?? 0n);
  }

  grab(hit: Hit): boolean {
    if (hit.body.view.motion !== Motion.dynamic) return false;
    this.selection.set(hit.body.id);
    const turn = new three.Quaternion(...hit.body.orientation).invert();
    const point = new three.Vector3(...hit.point).sub(new three.Vector3(...hit.body.position)).applyQuaternion(turn);
    this.held = { body: hit.body.id, point, to: new three.Vector3(...hit.point) };
    return true;
  }

  drag(to: three.Vector3): void {
    if (!this.held) return;
    this.held.to.copy(to);
    this.play(true);
  }

  release(): void {
    this.held = null;
  }

  /** From the held point to the hand. */
  get pulled(): three.Vector3[] | null {
    if (!this.held) return null;
    const body = new Body(this.lead.world, this.held.body);
    if (!body.exists) return null;
    const from = this.held.point.clone().applyQuaternion(new three.Quaternion(...body.orientation)).add(new three.Vector3(...body.position));
    return [from, this.held.to];
  }

  key(key: string): boolean {
    const at = "123456".indexOf(key);
    if (at >= 0 && SWITCHES[at]) {
      document.getElementById(`show-${SWITCHES[at]}`)?.click();
      return true;
    }
    const deeds: Record<string, () => void> = {
      f: () => this.throwOne(), b: () => this.drop(), x: () => this.removeChosen(), u: () => this.pushChosen(),
      c: () => this.setColour(COLOURINGS[(COLOURINGS.indexOf(this.colour) + 1) % COLOURINGS.length]!),
    };
    deeds[key]?.();
    return key in deeds;
  }

  /** A scene as a file of JSON. */
  async openFile(file: File): Promise<void> {
    try {
      const own = new OwnScene(await file.text(), file.name);
      this.change(own.name, 1n, {}, own);
    } catch (error) {
      this.refused = error instanceof Error ? error.message : String(error);
    }
  }

  /** Empty of a scene of one's own: the link has no room for it. */
  link(): string {
    const { lead } = this;
    if (lead.own) return "";
    const before = new Map([...lead.journal].filter(([tick]) => tick < lead.tick));
    return linkOf({
      scene: lead.name, seed: lead.seed, values: this.unusual(), tick: lead.tick, camera: this.picture.pose, overlays: [...this.shown],
      colour: this.colour, journal: before,
    });
  }

  destroy(): void {
    this.lead.destroy();
    for (const diorama of this.dioramas) diorama.dispose();
  }

  private open(name: string, seed: bigint, values: Values, own?: OwnScene): TestbedStage {
    const stage = new TestbedStage(this.engine, name, seed, valuesOf(this.engine.sceneParameters(name), values), own);
    for (const diorama of this.dioramas) diorama.dispose();
    const paint = painterOf(() => this.colour, () => this.shown.has("sleeping"), () => this.selection.row);
    this.dioramas = [new Diorama(stage, paint)];
    this.held = null;
    this.selection.set(0n);
    this.picture.frame(stage);
    return stage;
  }

  /** The parameters that are not as usual. */
  private unusual(): Values {
    const { name, values } = this.lead;
    const pairs = this.engine.sceneParameters(name).map((one, i): [string, number, number] => [one.name, values[i] ?? one.usual, one.usual]);
    return Object.fromEntries(pairs.filter(([, value, usual]) => value !== usual));
  }

  private change(name: string, seed: bigint, values: Values = {}, own?: OwnScene): void {
    const old = this.lead;
    this.lead = this.open(name, seed, values, own);
    this.refused = "";
    old.destroy();
    this.tellScene();
    this.measure();
    this.play(true);
  }

  private measure(): void {
    const { lead, charts } = this;
    const { kinetic, potential, contacts, islands } = lead.figures();
    charts.energy.series.set(lead.tick, kinetic + potential);
    charts.contacts.series.set(lead.tick, contacts);
    charts.islands.series.set(lead.tick, islands);
    if (lead.stepMs === 0) return;
    charts.ms.series.set(lead.tick, lead.stepMs);
    this.stages.set(lead.tick, lead.stageMs);
  }

  private pullOf({ body, point, to }: Held): Action {
    return pull(body, [point.x, point.y, point.z], [to.x, to.y, to.z]);
  }

  private throwOne(): void {
    const { camera } = this.picture;
    const way = camera.getWorldDirection(new three.Vector3());
    const from = camera.position.clone().addScaledVector(way, 0.25 * this.picture.distance * this.picture.radius);
    const speed = way.multiplyScalar(Math.max(THROW_SPEED, 1.5 * this.picture.radius));
    this.spawn(from, [speed.x, speed.y, speed.z]);
  }

  // Above the middle of the picture.
  private drop(): void {
    const { camera, radius } = this.picture;
    const way = camera.getWorldDirection(new three.Vector3()).multiplyScalar(500);
    const hit = castRay(this.lead.world, camera.position.toArray(), way.toArray());
    const over = new three.Vector3(...(hit?.point ?? this.picture.target.toArray()));
    this.spawn(over.add(new three.Vector3(0, 0.5 * radius, 0)), [0, 0, 0]);
  }

  private spawn(place: three.Vector3, speed: [number, number, number]): void {
    const size = Math.min(Math.max(0.06 * this.picture.radius, 0.15), 1);
    this.lead.act(spawn(SHAPES[this.shape], size, [place.x, place.y, place.z], speed));
    this.play(true);
  }

  private removeChosen(): void {
    if (this.selection.id === 0n) return;
    this.lead.act(remove(this.selection.id));
    this.selection.set(0n);
    this.play(true);
  }

  private pushChosen(): void {
    if (this.selection.id === 0n) return;
    this.lead.act(push(this.selection.id, [0, 5, 0]));
    this.play(true);
  }

  private setColour(colour: Colouring): void {
    this.colour = colour;
    const list = this.part<HTMLSelectElement>("colour");
    if (list) list.value = colour;
  }

  /** A part of the panel, whose parts the page takes over. */
  private part<Kind extends HTMLElement>(id: string): Kind | null {
    return this.panel.querySelector<Kind>(`#${id}`) ?? (document.getElementById(id) as Kind | null);
  }

  private tellScene(): void {
    const text = this.part("scene-text"), list = this.part<HTMLSelectElement>("scene-name");
    const index = this.engine.sceneNames().indexOf(this.lead.name);
    this.parameters.show(this.lead.own ? [] : this.engine.sceneParameters(this.lead.name), this.lead.values);
    if (list) list.value = this.lead.own ? "" : this.lead.name; // empty: any choice is a change
    if (text) text.textContent = this.lead.own ? `${this.lead.name}: a scene of your own` : this.engine.sceneText(index);
  }

  private fileOf(): HTMLElement {
    const input = make("input", { type: "file", accept: ".json,application/json", id: "scene-file" });
    input.onchange = () => input.files?.[0] && void this.openFile(input.files[0]);
    return make("label", { class: "field" }, make("span", {}, "or a file"), input);
  }

  private buildPanel(): void {
    const names = this.engine.sceneNames();
    const seed = make("input", { type: "number", id: "seed", min: "1", value: String(this.lead.seed) });
    seed.onchange = () => this.change(this.lead.name, BigInt(Math.max(1, Math.trunc(Number(seed.value)) || 1)), this.unusual(), this.lead.own);
    this.panel.append(
      section("Scene", select("scene-name", names, this.lead.name, (name) => this.change(name, this.lead.seed), "scene"),
        make("label", { class: "field" }, make("span", {}, "seed"), seed), this.parameters.element, make("p", { id: "scene-text" }), this.fileOf()),
      section("Hand", make("p", {}, "Drag a body to pull it; let go to throw it."),
        select("shape", Object.keys(SHAPES), this.shape, (name) => (this.shape = name as keyof typeof SHAPES), "shape"),
        make("div", { class: "row" }, button("Throw", "Throw one from the camera (F)", () => this.throwOne(), "throw"),
          button("Drop", "Drop one in the middle (B)", () => this.drop(), "drop"),
          button("Push up", "Push the chosen body up (U)", () => this.pushChosen(), "push"),
          button("Remove", "Remove the chosen body (X)", () => this.removeChosen(), "remove")), this.told),
      showSection(this.shown, this.colour, (colour) => (this.colour = colour), NAMES),
      section("Figures", make("div", { class: "charts" }, ...Object.values(this.charts).map((chart) => chart.element)), this.hashes.element, this.stages.element, this.counts.element),
      this.selection.element);
    this.tellScene();
  }
}
