// A world that is stepped elsewhere: it shows the present tick, and plays none by itself.
import { Stage } from "./stage.js";

export abstract class ElsewhereStage extends Stage {
  /** performance.now() of the last move. */
  protected movedAt = performance.now();

  override get canStep(): boolean {
    return false;
  }
  get first(): number {
    return this.tick;
  }
  get last(): number {
    return this.tick;
  }

  /** ms from one move to the next. */
  protected abstract readonly intervalMs: number;

  /** Of the way from the last tick but one to the last tick. */
  get fraction(): number {
    return Math.min((performance.now() - this.movedAt) / this.intervalMs, 1);
  }

  protected advance(): void {}
  protected goTo(): void {}
}
