// The time of a tick's stages, one above another.
import { Series } from "./charts.js";
import { make, sheetOf } from "./dom.js";
import { STAGES } from "./engine.js";

type StageName = (typeof STAGES)[number];

/** Stages that a person tells apart, with their colour. */
const GROUPS: readonly { name: string; color: string; stages: readonly StageName[] }[] = [
  { name: "pairs", color: "#5b8def", stages: ["find_pairs"] },
  { name: "collide", color: "#2aa79b", stages: ["collide"] },
  { name: "solve", color: "#e0a030", stages: ["prepare", "solve", "store"] },
  { name: "move", color: "#c45fb4", stages: ["move", "continuous", "refresh"] },
  { name: "events, sleep", color: "#8a94a3", stages: ["events", "sleep"] },
];
const SMOOTHED = 15; // ticks of a written value

export class StageChart {
  readonly element: HTMLElement;
  private readonly canvas = make("canvas", { class: "chart", id: "chart-stages" });
  private readonly parts: { series: Series; value: HTMLElement; color: string; stages: number[] }[];

  constructor(private readonly ticks = 600) {
    this.parts = GROUPS.map(({ name, color, stages }) => {
      const value = make("output", { id: `stage-${name.split(",")[0]}` });
      return { series: new Series(), value, color, stages: stages.map((stage) => STAGES.indexOf(stage)) };
    });
    const legend = this.parts.map(({ value, color }, i) => {
      const swatch = make("span", { class: "swatch" });
      swatch.style.background = color;
      return make("figcaption", {}, make("span", {}, swatch, GROUPS[i]!.name), value);
    });
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "Times of the stages of ticks, one above another");
    this.element = make("figure", { class: "chart-box" }, make("figcaption", {}, make("span", {}, "Stages, ms")), this.canvas, ...legend);
  }

  /** Times of a tick's stages, ms, in the order of STAGES. */
  set(tick: number, times: Float64Array): void {
    for (const { series, stages } of this.parts) series.set(tick, stages.reduce((sum, stage) => sum + times[stage]!, 0));
  }

  /** The ticks before and after `tick` that are known. */
  draw(tick: number, last: number): void {
    for (const { series, value } of this.parts) value.textContent = written(mean(series, tick));
    const sheet = sheetOf(this.canvas);
    if (!sheet) return;
    const { pen, width, height } = sheet;
    pen.clearRect(0, 0, width, height);
    const end = Math.max(Math.min(last, tick + this.ticks / 2), this.ticks), begin = end - this.ticks;
    const most = this.most(begin, end);
    const column = width / this.ticks;
    for (let at = begin; at <= end; ++at) {
      let top = height;
      for (const { series, color } of this.parts) {
        const tall = (series.at(at) / most) * (height - 2);
        if (!(tall > 0)) continue;
        pen.fillStyle = color;
        pen.fillRect((at - begin) * column, top - tall, Math.max(column, 1), tall);
        top -= tall;
      }
    }
    pen.fillStyle = getComputedStyle(this.canvas).getPropertyValue("--mark");
    pen.fillRect((tick - begin) * column, 0, 1, height);
  }

  private most(begin: number, end: number): number {
    const sums: number[] = [];
    for (let at = begin; at <= end; ++at) {
      const sum = this.parts.reduce((all, { series }) => all + series.at(at), 0);
      if (sum > 0) sums.push(sum);
    }
    // A single slow tick, as the first one is, shall not flatten all others.
    sums.sort((a, b) => a - b);
    return Math.max(1.5 * (sums[Math.floor(0.98 * sums.length)] ?? 0), 1e-3);
  }
}

function mean(series: Series, tick: number): number {
  const known: number[] = [];
  for (let at = Math.max(0, tick - SMOOTHED + 1); at <= tick; ++at) if (series.at(at) >= 0) known.push(series.at(at));
  return known.length === 0 ? NaN : known.reduce((sum, value) => sum + value, 0) / known.length;
}

function written(ms: number): string {
  return Number.isNaN(ms) ? "–" : ms.toFixed(ms < 0.1 ? 3 : 2);
}
