// The world of a match that runs elsewhere: it moves on when the client says so.
import type { Client } from "../../web/src/client.js";
import type { Engine } from "./engine.js";
import { Stage } from "./stage.js";

export class LiveStage extends Stage {
  private movedAt = performance.now();

  /** The client has a world already. */
  constructor(engine: Engine, readonly client: Client) {
    super(engine, client.world!);
    this.view.reset();
  }

  override get hash(): string {
    return this.client.hash ?? "";
  }
  override get canStep(): boolean {
    return false;
  }
  get first(): number {
    return this.tick;
  }
  get last(): number {
    return this.tick;
  }

  /** The client has stepped. */
  follow(): void {
    this.view.update();
    this.movedAt = performance.now();
  }

  /** Of the way from the last tick but one to the last tick. */
  get fraction(): number {
    return Math.min(((performance.now() - this.movedAt) / 1000) * this.world.tickRate, 1);
  }

  /** The client owns the world. */
  override destroy(): void {
    this.client.destroy();
  }

  protected advance(): void {}
  protected goTo(): void {}
}
