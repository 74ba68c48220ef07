// Something that plays: a world, its poses to draw, and the ticks that one can go to.
import { View } from "../../web/src/view.js";
import type { World } from "../../web/src/world.js";
import type { Engine, Figures } from "./engine.js";

export abstract class Stage {
  readonly view: View;

  constructor(readonly engine: Engine, readonly world: World) {
    this.view = new View(world);
  }

  get tick(): number {
    return this.world.tick;
  }
  get hash(): string {
    return this.world.hash;
  }
  /** The first tick to go to. */
  abstract readonly first: number;
  /** The last tick to go to. */
  abstract readonly last: number;

  /** Whether another tick can be played. */
  get canStep(): boolean {
    return true;
  }

  /** Plays one tick. */
  step(): void {
    this.advance();
    this.view.update();
  }

  /** Whether ticks after `last` can be played too. */
  protected readonly isOpen: boolean = false;

  /** Goes to any tick between `first` and `last`, or later where the stage is open. */
  seek(tick: number): void {
    this.goTo(Math.max(this.isOpen ? tick : Math.min(tick, this.last), this.first));
    this.view.reset();
  }

  figures(): Figures {
    return this.engine.measure(this.world);
  }

  destroy(): void {
    this.world.destroy();
  }

  /** Computes one tick. */
  protected abstract advance(): void;
  protected abstract goTo(tick: number): void;
}
