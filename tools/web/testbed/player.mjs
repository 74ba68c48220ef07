// A scene that plays, and every tick of it that fits in memory, to go back to.
import { Snapshot, View, createScene } from "lockstone/full";

const HISTORY_BYTES = 128e6;
const MOST_TICKS = 1800;

export class Player {
  constructor(lockstone, name) {
    this.world = createScene(lockstone, name);
    this.view = new View(this.world);
    this.kept = new Map(); // snapshots by tick
    this.room = MOST_TICKS;
    this.last = 0;
    this.keep();
  }

  get tick() {
    return this.world.tick;
  }
  /** The earliest tick to go back to. */
  get first() {
    return this.kept.keys().next().value;
  }

  step() {
    this.world.step();
    this.view.update();
    this.last = Math.max(this.last, this.tick);
    if (!this.kept.has(this.tick)) this.keep();
  }

  /** Shows a tick that was played before. */
  seek(tick) {
    const snapshot = this.kept.get(tick);
    if (!snapshot) return;
    snapshot.load();
    this.view.reset();
  }

  destroy() {
    for (const snapshot of this.kept.values()) snapshot.destroy();
    this.world.destroy();
  }

  keep() {
    const full = this.kept.size >= this.room;
    const snapshot = full ? this.kept.get(this.first) : new Snapshot(this.world);
    if (full) this.kept.delete(this.first);
    this.room = Math.min(MOST_TICKS, Math.floor(HISTORY_BYTES / snapshot.capacity));
    snapshot.save();
    this.kept.set(this.tick, snapshot);
  }
}
