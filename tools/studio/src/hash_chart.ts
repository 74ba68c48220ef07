// The hash of every tick as a colour, and how far ticks that were computed twice had the same one.
import { make, sheetOf } from "./dom.js";

const STRIP = 0.72; // of the height; below it the verdicts

/** Hashes by tick, which are compared when a tick is computed again. */
export class HashRecord {
  private readonly hashes: string[] = [];
  private readonly again = new Set<number>();
  /** The first tick that came to another hash; null: none did. */
  different: number | null = null;
  /** The last tick that was computed again, with the same hash; 0: none was. */
  verified = 0;

  put(tick: number, hash: string): void {
    const before = this.hashes[tick];
    if (before === undefined) this.hashes[tick] = hash;
    else if (before === hash) {
      this.again.add(tick);
      this.verified = Math.max(this.verified, tick);
    } else this.different = Math.min(this.different ?? tick, tick);
  }

  at(tick: number): string | undefined {
    return this.hashes[tick];
  }
  isVerified(tick: number): boolean {
    return this.again.has(tick);
  }

  /** Forgets the ticks after this one: another future begins. */
  cut(tick: number): void {
    this.hashes.length = Math.min(this.hashes.length, tick + 1);
    for (const one of this.again) if (one > tick) this.again.delete(one);
    this.verified = Math.max(0, ...this.again);
    if (this.different !== null && this.different > tick) this.different = null;
  }
}

export class HashChart {
  readonly element: HTMLElement;
  private readonly canvas = make("canvas", { class: "chart", id: "chart-hash" });
  private readonly told = make("output", { id: "hash-verified" });

  constructor(private readonly ticks = 600) {
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "The hash of each tick as a colour; green below it: computed again, with the same hash");
    this.element = make("figure", { class: "chart-box" }, make("figcaption", {}, make("span", {}, "Hash"), this.told), this.canvas);
  }

  /** The ticks before and after `tick` that are known. */
  draw(record: HashRecord, tick: number, last: number): void {
    const { different, verified } = record;
    this.told.textContent = different !== null ? `✗ tick ${different} came to another hash` : verified > 0 ? `✓ computed again to tick ${verified}` : "computed once";
    const sheet = sheetOf(this.canvas);
    if (!sheet) return;
    const { pen, width, height } = sheet;
    const style = getComputedStyle(this.canvas);
    const [good, bad, idle, mark] = ["--good", "--bad", "--idle", "--mark"].map((name) => style.getPropertyValue(name));
    pen.clearRect(0, 0, width, height);
    const end = Math.max(Math.min(last, tick + this.ticks / 2), this.ticks), begin = end - this.ticks;
    const column = width / this.ticks, split = Math.round(STRIP * height);
    for (let at = begin; at <= end; ++at) {
      const hash = record.at(at);
      if (hash === undefined) continue;
      const x = (at - begin) * column;
      pen.fillStyle = colorOf(hash);
      pen.fillRect(x, 0, Math.max(column, 1), split);
      pen.fillStyle = at === different ? bad! : record.isVerified(at) ? good! : idle!;
      pen.fillRect(x, split + 2, Math.max(column, 1), height - split - 2);
    }
    pen.fillStyle = mark!;
    pen.fillRect((tick - begin) * column, 0, 1, height);
  }
}

// Hashes that differ in one bit have nothing in common: any of their bits do.
function colorOf(hash: string): string {
  const bits = parseInt(hash.slice(0, 6), 16);
  return `hsl(${bits % 360} ${45 + ((bits >> 9) % 40)}% ${40 + ((bits >> 15) % 30)}%)`;
}
