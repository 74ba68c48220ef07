// A game that runs elsewhere and shows its world: watched only.
import type { Hit } from "../../web/src/queries.js";
import { Chart } from "./charts.js";
import { Facts, make, section } from "./dom.js";
import { Drawn, type Engine, STRIDE } from "./engine.js";
import type { Mode } from "./mode.js";
import { type Colouring, painterOf } from "./paint.js";
import { Diorama, type Picture } from "./picture.js";
import { Selection } from "./selection.js";
import type { WatchedWorld } from "./session.js";
import { showSection } from "./show.js";
import { WorldLink } from "./world_link.js";
import { WorldStage } from "./world_stage.js";

const WAIT_MS = 10_000; // for the first state
const MOST_MISSED = 600; // ticks that a chart shows
const COUNTS = ["bodies", "awake", "asleep", "islands", "joints"] as const;

/** A world with its first state, and the connection that goes on. */
interface Connected {
  stage: WorldStage;
  link: WorldLink;
}

export class WorldView implements Mode {
  readonly panel = make("div");
  readonly lane = null;
  readonly labels = [];
  readonly shown = new Set<string>(["triggers", "sleeping"]);
  readonly lead: WorldStage;
  readonly dioramas: Diorama[];
  private readonly connection: WorldLink;
  private readonly selection = new Selection();
  private readonly facts = new Facts("world", ["game", "state", "states received"]);
  private readonly counts = new Facts("count", [...COUNTS, "points"]);
  private readonly charts = {
    energy: new Chart("Energy", "J", "chart-energy"), points: new Chart("Contact points", "", "chart-points"),
    islands: new Chart("Islands", "", "chart-islands"),
  };
  private colour: Colouring = "body";
  private received = 0;
  private points = 0;
  private seen = 0; // the last tick
  private over = false;

  /** Waits for the first state of the game. */
  static async open(engine: Engine, picture: Picture, watched: WatchedWorld): Promise<WorldView> {
    let view: WorldView | null = null;
    const { stage, link } = await new Promise<Connected>((done, fail) => {
      let stage: WorldStage | null = null;
      const timer = setTimeout(() => fail(new Error(`${watched.url}: no state of a world`)), WAIT_MS);
      const news = {
        description: (bytes: Uint8Array) => {
          try {
            stage = new WorldStage(engine, bytes);
          } catch (error) {
            fail(error);
          }
        },
        state: (bytes: Uint8Array) => {
          if (!stage) return;
          stage.take(bytes);
          clearTimeout(timer);
          if (view) view.hear();
          else done({ stage, link });
        },
        ended: () => {
          clearTimeout(timer);
          view?.end();
          fail(new Error(`${watched.url}: no game shows its world there with this token`));
        },
      };
      const link = new WorldLink(watched.url, watched.token, news);
    });
    view = new WorldView(picture, watched, stage, link);
    return view;
  }

  private constructor(private readonly picture: Picture, private readonly watched: WatchedWorld, stage: WorldStage, link: WorldLink) {
    this.lead = stage;
    this.connection = link;
    const paint = painterOf(() => this.colour, () => this.shown.has("sleeping"), () => this.selection.row);
    this.dioramas = [new Diorama(stage, paint)];
    picture.frame(stage);
    this.hear();
    this.panel.append(
      section("Game", this.facts.element, make("p", {}, "The game computes; this page only looks.")),
      showSection(this.shown, this.colour, (colour) => (this.colour = colour)),
      section("Figures", make("div", { class: "charts" }, ...Object.values(this.charts).map((chart) => chart.element)), this.counts.element),
      this.selection.element);
  }

  step(): void {}
  seek(): void {}

  get fraction(): number {
    return this.lead.fraction;
  }

  refresh(): void {
    const { lead, charts } = this;
    for (const chart of Object.values(charts)) chart.draw(lead.tick, lead.tick);
    this.facts.set("game", this.watched.url);
    this.facts.set("state", this.over ? "ended" : "runs");
    this.facts.set("states received", String(this.received));
    const figures = lead.figures();
    for (const name of COUNTS) this.counts.set(name, String(figures[name]));
    this.counts.set("points", String(this.points));
    this.selection.refresh(lead.world, this.picture.target);
  }

  choose(hit: Hit | null): void {
    this.selection.set(hit?.body.id ?? 0n);
  }

  destroy(): void {
    this.connection.close();
    this.lead.destroy();
    for (const diorama of this.dioramas) diorama.dispose();
  }

  private hear(): void {
    ++this.received;
    const { lead, charts } = this;
    const { kinetic, potential, islands } = lead.figures();
    // The last step was the game's, and its counts are no part of the state.
    this.points = lead.engine.draw(lead.world, Drawn.contacts).contacts.length / STRIDE.contacts;
    // Ticks whose states the page did not get have the figures of the next one.
    for (let tick = Math.max(this.seen, lead.tick - MOST_MISSED) + 1; tick <= lead.tick; ++tick) {
      charts.energy.series.set(tick, kinetic + potential);
      charts.points.series.set(tick, this.points);
      charts.islands.series.set(tick, islands);
    }
    this.seen = lead.tick;
  }

  private end(): void {
    this.over = true;
  }
}
