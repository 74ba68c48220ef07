// A log that plays: every tick is compared with the recorded hash.
import { LKS_CANONICAL } from "../../web/src/declarations.js";
import type { Engine } from "./engine.js";
import { History, States } from "./history.js";
import type { LogFile } from "./log_file.js";
import { Stage } from "./stage.js";

export const Proof = { unknown: 0, same: 1, different: 2 } as const;
const KEEP_EVERY = 15; // ticks
const MOST_BYTES = 512e6;
const CHEAP_TICKS = 60; // that are computed while a finger moves
const FIRST_MS = 25; // of computing before the first picture of a tick that is sought

/** Verdicts on each tick of a log. */
export class Proofs {
  readonly verdicts: Uint8Array;
  /** The first tick whose hash differs. */
  firstDifferent: number | null = null;
  proved = 0;

  constructor(readonly startTick: number, ticks: number) {
    this.verdicts = new Uint8Array(ticks);
  }

  mark(tick: number, same: boolean): void {
    const at = tick - this.startTick;
    if (this.verdicts[at] === Proof.unknown && same) ++this.proved;
    this.verdicts[at] = same ? Proof.same : Proof.different;
    if (!same && (this.firstDifferent === null || tick < this.firstDifferent)) this.firstDifferent = tick;
  }

  of(tick: number): number {
    return this.verdicts[tick - this.startTick] ?? Proof.unknown;
  }
}

export class LogStage extends Stage {
  readonly first: number;
  readonly last: number;
  readonly proofs: Proofs;
  readonly history = new History(KEEP_EVERY, MOST_BYTES);
  /** The tick that is being approached; null: it is reached. */
  goal: number | null = null;
  private readonly states: States;
  /** A state that is not computed from the log's beginning: of another build, or with a fault. */
  private anchor: { tick: number; state: Uint8Array } | null = null;

  constructor(engine: Engine, readonly log: LogFile, proofs?: Proofs) {
    super(engine, log.makeWorld());
    this.first = log.startTick;
    this.last = log.endTick;
    this.proofs = proofs ?? new Proofs(log.startTick, log.ticks);
    this.states = new States(this.world, LKS_CANONICAL);
    this.history.put(this.first, this.states.save());
  }

  override get canStep(): boolean {
    return this.tick < this.last;
  }

  /** From its tick on, the world comes from this state. */
  setAnchor(tick: number, state: Uint8Array): void {
    this.anchor = { tick, state };
    this.history.cut(Math.max(tick - 1, this.first));
  }

  /** A canonical state that another instance computed. */
  keep(tick: number, state: Uint8Array): void {
    this.history.put(tick, state);
  }

  /** The tick itself, or an earlier one that takes less computing to go to. */
  cheapTick(tick: number): number {
    const near = this.nearest(Math.min(Math.max(tick, this.first), this.last)).tick;
    return tick - near > CHEAP_TICKS ? near : tick;
  }

  /** Goes to the nearest known state before a tick, and on towards it: `work` does the rest. */
  approach(tick: number): void {
    const wanted = Math.min(Math.max(tick, this.first), this.last);
    const from = this.nearest(wanted);
    if (this.tick > wanted || from.tick > this.tick) from.load();
    this.goal = wanted;
    this.work(FIRST_MS);
  }

  /** Computes towards the goal for a part of a frame. */
  work(ms: number): void {
    if (this.goal === null) return;
    for (const began = performance.now(); this.tick < this.goal && performance.now() - began < ms;) this.advance();
    this.view.reset();
    if (this.tick >= this.goal) this.goal = null;
  }

  save(): Uint8Array {
    return this.states.save();
  }

  protected advance(): void {
    const { tick } = this;
    if (!this.canStep) return;
    if (this.anchor?.tick === tick + 1) {
      this.log.step(this.world);
      this.states.load(this.anchor.state);
      return;
    }
    // A tick that is proved already comes from a state that is proved: its hash is known.
    if (!this.anchor && this.proofs.of(tick) === Proof.same) {
      this.log.stepUnseen(this.world);
    } else {
      const same = this.log.step(this.world);
      if (!this.anchor) this.proofs.mark(tick, same);
    }
    if (this.history.wants(tick + 1)) this.history.put(tick + 1, this.states.save());
  }

  protected goTo(tick: number): void {
    const from = this.nearest(tick);
    if (this.tick > tick || from.tick > this.tick) from.load();
    while (this.tick < tick) this.advance();
  }

  // The best state to start from: computed here, given, or recorded in the log.
  private nearest(tick: number): { tick: number; load: () => void } {
    const kept = this.history.before(tick)!; // the first tick is always kept
    let best = { tick: kept.tick, load: () => this.states.load(kept.state) };
    const { anchor, log } = this;
    if (anchor && anchor.tick <= tick && anchor.tick >= best.tick) {
      best = { tick: anchor.tick, load: () => this.states.load(anchor.state) };
    }
    const index = log.keyframes.findLastIndex((at) => at <= tick);
    const recorded = log.keyframes[index] ?? -1;
    // A recorded state behind a difference is not what this build computes.
    const { firstDifferent } = this.proofs;
    const computed = !this.anchor && (firstDifferent === null || recorded <= firstDifferent);
    if (computed && recorded > best.tick) best = { tick: recorded, load: () => log.loadKeyframe(this.world, index) };
    return best;
  }
}
