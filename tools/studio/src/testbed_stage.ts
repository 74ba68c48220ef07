// A scene that a person plays with. All that the person does is kept by tick, so that every tick
// can be computed again, here or behind a link.
import { type Action, putAction } from "./action.js";
import type { Engine } from "./engine.js";
import { HashRecord } from "./hash_chart.js";
import { History, States } from "./history.js";
import type { OwnScene } from "./own_scene.js";
import { Stage } from "./stage.js";

const KEEP_EVERY = 15; // ticks

export class TestbedStage extends Stage {
  readonly first = 0;
  protected override readonly isOpen = true;
  last = 0;
  /** What was done before the step of a tick. */
  readonly journal = new Map<number, Action[]>();
  /** Why the last action was refused; empty where it was not. */
  refusal = "";
  /** ms of the last step, and of its stages in the order of STAGES. */
  stepMs = 0;
  stageMs: Float64Array;
  readonly hashes = new HashRecord();
  private stageSums: Float64Array;
  private readonly states: States;
  private readonly history = new History(KEEP_EVERY);

  /** A built-in scene by its name, or one of a person's own. */
  constructor(engine: Engine, readonly name: string, readonly seed: bigint, readonly values: readonly number[] = [], readonly own?: OwnScene) {
    super(engine, own ? own.makeWorld(engine) : engine.scene(name, seed, values));
    engine.watchStages(this.world);
    this.stageSums = this.stageMs = engine.stageTimes(this.world);
    this.states = new States(this.world);
    this.keep();
    this.hashes.put(0, this.hash);
  }

  /** Does something before the next step. A future that was played before is forgotten. */
  act(action: Action): void {
    const { tick } = this;
    if (tick < this.last) this.forgetFuture(tick);
    this.journal.set(tick, [...(this.journal.get(tick) ?? []), action]);
  }

  /** Takes over the actions of another page; calls `played` after each tick. */
  replay(journal: ReadonlyMap<number, Action[]>, until: number, played: () => void): void {
    for (const [tick, actions] of journal) this.journal.set(tick, actions);
    while (this.tick < until) {
      this.advance();
      played();
    }
    this.view.reset();
  }

  protected advance(): void {
    const { tick } = this;
    for (const action of this.journal.get(tick) ?? []) this.perform(action);
    const began = performance.now();
    this.world.step();
    this.stepMs = performance.now() - began;
    const sums = this.engine.stageTimes(this.world);
    this.stageMs = sums.map((sum, stage) => sum - this.stageSums[stage]!);
    this.stageSums = sums;
    this.last = Math.max(this.last, tick + 1);
    this.hashes.put(tick + 1, this.hash);
    this.keep();
  }

  protected goTo(tick: number): void {
    const from = this.history.before(tick);
    if (from && (this.tick > tick || from.tick > this.tick)) this.states.load(from.state);
    while (this.tick < tick) this.advance();
  }

  private perform(action: Action): void {
    const { heap, f } = this.engine;
    try {
      heap.check(f.lks_studio_act(this.world.address, putAction(heap, action)));
      this.refusal = "";
    } catch (error) {
      this.refusal = String(error); // the body is gone, or there is no room: alike in every replay
    }
  }

  private forgetFuture(tick: number): void {
    for (const at of [...this.journal.keys()]) if (at >= tick) this.journal.delete(at);
    this.history.cut(tick);
    this.hashes.cut(tick);
    this.last = tick;
  }

  private keep(): void {
    const { tick } = this;
    if (this.history.wants(tick)) this.history.put(tick, this.states.save());
  }
}
