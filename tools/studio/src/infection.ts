// How a difference spreads: which body differed first, and from whom each other one had it.
import * as three from "three";
import { Drawn, type Engine, STRIDE } from "./engine.js";
import type { World } from "../../web/src/world.js";
import { islandColor } from "./paint.js";

const LANE = 15, WIDTH = 290, LEFT = 34, DOT = 4; // px
const MOST_LANES = 60;
const SVG = "http://www.w3.org/2000/svg";

export interface Infected {
  row: number;
  /** The first tick at which it differs. */
  tick: number;
  /** The rows that it touched or hung on, which differed before; empty: it began here. */
  from: number[];
  /** The row of its island then; -1: none. */
  island: number;
}

/** Pairs of rows that touch or are joined, in both directions. */
function neighbours(engine: Engine, worlds: readonly World[]): Map<number, Set<number>> {
  const found = new Map<number, Set<number>>();
  const add = (a: number, b: number) => found.set(a, (found.get(a) ?? new Set()).add(b));
  const addAll = (list: Float32Array, stride: number, first: number) => {
    for (let at = 0; at < list.length; at += stride) {
      add(list[at + first]!, list[at + first + 1]!);
      add(list[at + first + 1]!, list[at + first]!);
    }
  };
  for (const world of worlds) {
    const { contacts, joints } = engine.draw(world, Drawn.contacts | Drawn.joints);
    addAll(contacts, STRIDE.contacts, 0);
    addAll(joints, STRIDE.joints, 1);
  }
  return found;
}

function islands(engine: Engine, world: World): Map<number, number> {
  const found = new Map<number, number>();
  const { bodies } = engine.draw(world, Drawn.bodies);
  for (let at = 0; at < bodies.length; at += STRIDE.bodies) found.set(bodies[at]!, bodies[at + 2]!);
  return found;
}

export class Infection {
  readonly element = document.createElementNS(SVG, "svg");
  readonly all: Infected[] = [];
  private readonly known = new Map<number, Infected>();
  private touching = new Map<number, Set<number>>();
  private noted = -1;

  /** `look`: a body was chosen. */
  constructor(private readonly engine: Engine, private readonly look: (row: number) => void) {
    this.element.id = "infection";
    this.element.setAttribute("role", "img");
    this.element.setAttribute("aria-label", "Bodies in the order in which they began to differ, and from which other they had it");
  }

  /** The rows that differ at a tick. Ticks must come one after another; others are known already. */
  note(tick: number, worlds: readonly World[], rows: readonly number[]): void {
    if (this.noted >= 0 && tick !== this.noted + 1) return;
    if (this.noted < 0 && rows.length === 0) return;
    this.noted = tick;
    // Bodies that met in this tick touch after it, those that parted touched before.
    const before = this.touching;
    this.touching = neighbours(this.engine, worlds);
    const fresh = rows.filter((row) => !this.known.has(row));
    if (fresh.length === 0) return;
    this.addAll(tick, new Set(fresh), (row) => new Set([...(before.get(row) ?? []), ...(this.touching.get(row) ?? [])]), islands(this.engine, worlds[0]!));
    this.draw();
  }

  // A tick may carry a difference across a whole island: bodies next to those that differ come first, then those next to them.
  private addAll(tick: number, fresh: Set<number>, near: (row: number) => Set<number>, island: Map<number, number>): void {
    const differing = (rows: Iterable<number>) => [...rows].filter((row) => this.known.has(row))
      .sort((a, b) => this.known.get(a)!.tick - this.known.get(b)!.tick || a - b);
    const islandOf = (row: number) => island.get(row) ?? -1;
    const inIsland = (row: number) => differing(island.keys()).filter((other) => islandOf(row) >= 0 && islandOf(other) === islandOf(row)).slice(0, 1);
    for (let ring = [...fresh]; fresh.size > 0; ring = ring.filter((row) => fresh.has(row))) {
      let found: Infected[] = ring.map((row) => ({ row, tick, from: differing(near(row)), island: islandOf(row) })).filter(({ from }) => from.length > 0);
      // The rest is not next to any: a body between them came to the same state, or it begins here.
      if (found.length === 0) found = ring.map((row) => ({ row, tick, from: inIsland(row), island: islandOf(row) }));
      for (const one of found) {
        this.known.set(one.row, one);
        fresh.delete(one.row);
      }
      this.all.push(...found);
    }
  }

  private draw(): void {
    const shown = this.all.slice(0, MOST_LANES);
    const first = shown[0]!.tick, last = Math.max(shown.at(-1)!.tick, first + 1);
    const lane = new Map(shown.map(({ row }, i) => [row, i]));
    const x = (tick: number) => LEFT + ((tick - first) / (last - first)) * (WIDTH - LEFT - 2 * DOT);
    const y = (row: number) => (lane.get(row)! + 0.7) * LANE;
    const height = (shown.length + 1) * LANE;
    this.element.replaceChildren();
    this.element.setAttribute("viewBox", `0 0 ${WIDTH} ${height}`);
    const color = new three.Color();
    for (const { row, tick, from } of shown) {
      const source = from.find((one) => lane.has(one));
      if (source !== undefined) this.add("line", { x1: x(this.known.get(source)!.tick), y1: y(source), x2: x(tick), y2: y(row) });
    }
    for (const { row, tick, from, island } of shown) {
      const fill = island < 0 ? "currentColor" : `#${islandColor(island, color).getHexString(three.SRGBColorSpace)}`;
      const dot = this.add("circle", { cx: x(tick), cy: y(row), r: DOT, fill });
      dot.addEventListener("click", () => this.look(row));
      const title = document.createElementNS(SVG, "title");
      title.textContent = `body ${row}, tick ${tick}${from.length > 0 ? `, from body ${from.join(", ")}` : ", the first"}`;
      dot.append(title);
      this.add("text", { x: LEFT - 8, y: y(row) + 4, "text-anchor": "end" }).textContent = String(row);
    }
    this.add("text", { x: LEFT, y: height - 2 }).textContent = `tick ${first}`;
    this.add("text", { x: WIDTH, y: height - 2, "text-anchor": "end" }).textContent =
      this.all.length > shown.length ? `${last}, ${this.all.length - shown.length} more bodies later` : String(last);
  }

  private add(name: string, attributes: Record<string, string | number>): SVGElement {
    const element = document.createElementNS(SVG, name) as SVGElement;
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
    this.element.append(element);
    return element;
  }
}
