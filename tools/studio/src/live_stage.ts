// The world of a match that runs elsewhere: it moves on when the client says so.
import type { Client } from "../../web/src/client.js";
import { ElsewhereStage } from "./elsewhere_stage.js";
import type { Engine } from "./engine.js";

export class LiveStage extends ElsewhereStage {
  /** The client has a world already. */
  constructor(engine: Engine, readonly client: Client) {
    super(engine, client.world!);
    this.view.reset();
  }

  override get hash(): string {
    return this.client.hash ?? "";
  }

  /** The client has stepped. */
  follow(): void {
    this.view.update();
    this.movedAt = performance.now();
  }

  protected get intervalMs(): number {
    return 1000 / this.world.tickRate;
  }

  /** The client owns the world. */
  override destroy(): void {
    this.client.destroy();
  }
}
