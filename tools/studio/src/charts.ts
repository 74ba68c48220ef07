// Small charts of figures by tick.
import { make, sheetOf } from "./dom.js";

/** Values by tick, which may be written again after a rewind. */
export class Series {
  private values = new Float32Array(1024).fill(NaN);

  set(tick: number, value: number): void {
    if (tick >= this.values.length) {
      const grown = new Float32Array(2 * Math.max(tick, this.values.length)).fill(NaN);
      grown.set(this.values);
      this.values = grown;
    }
    this.values[tick] = value;
  }

  at(tick: number): number {
    return this.values[tick] ?? NaN;
  }
}

/** How a chart writes and places its values. */
export interface Scale {
  text(value: number): string;
  /** The height of a value, in any unit. */
  height(value: number): number;
}

function plain(unit: string): Scale {
  return { text: (value) => `${short(value)} ${unit}`.replace(/([kM]) (?=\S)/, "$1"), height: (value) => value };
}

function short(value: number): string {
  if (Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  if (size >= 1e6) return `${(value / 1e6).toFixed(2)} M`;
  if (size >= 1e4) return `${(value / 1e3).toFixed(1)} k`;
  return Number.isInteger(value) ? String(value) : value.toFixed(size < 10 ? 2 : 1);
}

export class Chart {
  readonly element: HTMLElement;
  readonly series = new Series();
  private readonly canvas = make("canvas", { class: "chart" });
  private readonly value: HTMLElement;

  private readonly scale: Scale;

  /** `unit`: its name, or a scale of its own. */
  constructor(title: string, unit: string | Scale, id: string, private readonly ticks = 600) {
    this.scale = typeof unit === "string" ? plain(unit) : unit;
    this.value = make("output", { id });
    this.element = make("figure", { class: "chart-box" }, make("figcaption", {}, make("span", {}, title), this.value), this.canvas);
    this.canvas.setAttribute("aria-label", title);
    this.canvas.setAttribute("role", "img");
  }

  /** The ticks before and after `tick` that are known. */
  draw(tick: number, last: number): void {
    this.value.textContent = this.scale.text(this.series.at(tick));
    const sheet = sheetOf(this.canvas);
    if (!sheet) return;
    const { pen, width, height } = sheet;
    const style = getComputedStyle(this.canvas);
    pen.clearRect(0, 0, width, height);
    const end = Math.max(Math.min(last, tick + this.ticks / 2), this.ticks), begin = end - this.ticks;
    const [low, high] = this.range(begin, end);
    const x = (at: number) => ((at - begin) / this.ticks) * (width - 1);
    const y = (value: number) => height - 3 - ((value - low) / (high - low)) * (height - 6);
    pen.strokeStyle = style.getPropertyValue("--accent");
    pen.lineWidth = 1.5;
    pen.beginPath();
    let drawing = false;
    for (let at = begin; at <= end; ++at) {
      const value = this.scale.height(this.series.at(at));
      if (Number.isNaN(value)) drawing = false;
      else if (drawing) pen.lineTo(x(at), y(value));
      else {
        pen.moveTo(x(at), y(value));
        drawing = true;
      }
    }
    pen.stroke();
    pen.fillStyle = style.getPropertyValue("--mark");
    pen.fillRect(x(tick), 0, 1, height);
  }

  private range(begin: number, end: number): [number, number] {
    let low = Infinity, high = -Infinity;
    for (let at = begin; at <= end; ++at) {
      const value = this.scale.height(this.series.at(at));
      if (value < low) low = value;
      if (value > high) high = value;
    }
    if (low > high) return [0, 1];
    if (low > 0 && low < 0.7 * high) low = 0;
    return high - low < 1e-9 ? [low - 0.5, high + 0.5] : [low, high];
  }
}
