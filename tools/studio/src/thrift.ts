// Plainer pictures while they move, where a processor draws: twenty a second of a thousand bodies, not five.
import { SOFTWARE } from "./software.js";

const WANTED_MS = 40; // between two pictures
const LOOK_EVERY = 4; // pictures
const LEAST_SCALE = 0.3;
const SHADOWS_AT_ONCE = 150; // meshes whose shadows every picture draws anew
const FIGURES_EVERY = 8; // pictures: figures and charts cost a third of the page's own time

/** Chooses the size of pictures by the time that they take, and how often shadows and figures are drawn. */
export class Thrift {
  /** Pixels of the picture for one of the page, in each direction. */
  scale = 1;
  /** That of the last time that the picture moved. */
  private kept = 1;
  private pictures = 0;
  private began = 0;

  /** Before each picture; `moves`: another one follows at once. */
  next(moves: boolean, now: number): void {
    if (!SOFTWARE || !moves) {
      this.pictures = 0;
      this.scale = 1;
      return;
    }
    if (this.pictures++ % LOOK_EVERY !== 0) return;
    const each = (now - this.began) / LOOK_EVERY;
    this.began = now;
    if (this.pictures === 1) this.scale = this.kept;
    else if (each > WANTED_MS) this.scale = Math.max(this.scale * Math.sqrt(WANTED_MS / each), LEAST_SCALE);
    else if (each < 0.5 * WANTED_MS) this.scale = Math.min(1.25 * this.scale, 1);
    this.kept = this.scale;
  }

  /** Whether figures and charts are drawn with this picture. */
  get wantsFigures(): boolean {
    return this.pictures % FIGURES_EVERY === 0;
  }

  /** Whether this picture draws the shadows of so many meshes anew. */
  wantsShadows(meshes: number): boolean {
    return this.pictures === 0 || this.pictures % Math.ceil(meshes / SHADOWS_AT_ONCE) === 0;
  }
}
