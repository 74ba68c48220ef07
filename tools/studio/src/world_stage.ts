// The world of a game that runs elsewhere: each of its states replaces the one before.
import { LKS_CANONICAL } from "../../web/src/declarations.js";
import { ElsewhereStage } from "./elsewhere_stage.js";
import type { Engine } from "./engine.js";
import { States } from "./history.js";

export class WorldStage extends ElsewhereStage {
  private readonly states: States;
  protected intervalMs = 1000 / 60;

  /** `description`: the message of a WorldServer. */
  constructor(engine: Engine, description: Uint8Array) {
    super(engine, engine.describedWorld(description));
    this.states = new States(this.world, LKS_CANONICAL);
  }

  /** Takes over a state, as its canonical snapshot. */
  take(state: Uint8Array): void {
    const before = this.tick;
    this.states.load(state);
    if (this.tick > before && before > 0) this.view.update();
    else this.view.reset();
    const now = performance.now();
    this.intervalMs = Math.min(Math.max(now - this.movedAt, 1), 250);
    this.movedAt = now;
  }
}
