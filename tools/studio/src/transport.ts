// Play, pause, single ticks, back, speed: for whatever view is open.
import { byId } from "./dom.js";
import type { Mode } from "./mode.js";

const MOST_MS = 24; // of steps in one frame
const REWIND = 600; // ticks

export class Transport {
  playing = false;
  speed = 1;
  /** Of the next tick, for the picture. */
  private due = 0;
  private last = performance.now();
  private readonly slider = byId<HTMLInputElement>("slider");

  constructor(private readonly mode: () => Mode | null) {
    byId("play").onclick = () => this.play(!this.playing);
    byId("step").onclick = () => this.stepOnce();
    byId("back").onclick = () => this.move(-1);
    byId("restart").onclick = () => this.seek(0);
    byId("rewind").onclick = () => this.move(-REWIND);
    this.slider.oninput = () => this.seek(Number(this.slider.value));
    byId<HTMLSelectElement>("speed").onchange = ({ target }) => (this.speed = Number((target as HTMLSelectElement).value));
  }

  get fraction(): number {
    return this.playing ? Math.min(this.due, 1) : 1;
  }

  play(wanted: boolean): void {
    this.playing = wanted;
    this.due = 0;
    byId("play").setAttribute("aria-pressed", String(wanted));
  }

  stepOnce(): void {
    this.play(false);
    if (this.mode()?.lead.canStep) this.mode()?.step();
  }

  move(ticks: number): void {
    const mode = this.mode();
    if (mode) this.seek(mode.lead.tick + ticks);
  }

  seek(tick: number): void {
    this.play(false);
    this.mode()?.seek(tick);
  }

  /** Plays one tick, however long ago the last one was. */
  advanceOnce(): void {
    const mode = this.mode();
    this.last = performance.now();
    if (!mode || !this.playing) return;
    if (mode.lead.canStep) mode.step();
    else this.play(false);
  }

  /** Plays the ticks that are due. */
  advance(now: number): void {
    const mode = this.mode();
    const seconds = (now - this.last) / 1000;
    this.last = now;
    if (!mode || !this.playing) return;
    this.due = Math.min(this.due + seconds * mode.lead.world.tickRate * this.speed, 12);
    for (const began = performance.now(); this.due >= 1; --this.due) {
      if (!mode.lead.canStep) return this.play(false);
      mode.step();
      if (performance.now() - began > MOST_MS) {
        this.due = Math.min(this.due, 2); // a slow machine plays slower
        return;
      }
    }
  }

  refresh(): void {
    const mode = this.mode();
    if (!mode) return;
    const { lead } = mode;
    Object.assign(this.slider, { min: String(lead.first), max: String(Math.max(lead.last, lead.tick)), value: String(mode.goal ?? lead.tick) });
  }
}
