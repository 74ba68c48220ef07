// States of a world to go back to, kept outside of the module's memory.
import * as c from "../../web/src/declarations.js";
import type { World } from "../../web/src/world.js";

/** Reads and writes states of one world as bytes of their exact length. */
export class States {
  private readonly room: number;
  private readonly most: number;

  constructor(private readonly world: World, private readonly kind: number = c.LKS_NATIVE) {
    const { heap, address } = world;
    heap.check(heap.f.lks_snapshot_bytes_max(address, kind, heap.output));
    this.most = heap.getWord(heap.output);
    this.room = world.allocate(this.most);
  }

  save(): Uint8Array<ArrayBuffer> {
    const { heap, address } = this.world;
    heap.check(heap.f.lks_save(address, this.kind, this.room, this.most, heap.output));
    const bytes = new Uint8Array(heap.getWord(heap.output));
    bytes.set(heap.u8.subarray(this.room, this.room + bytes.length));
    return bytes;
  }

  load(bytes: Uint8Array): void {
    const { heap, address } = this.world;
    heap.u8.set(bytes, this.room);
    heap.check(heap.f.lks_load(address, this.kind, this.room, bytes.length));
  }
}

/** States by tick, the first one included. When they hold more than their share of memory, every second one goes. */
export class History {
  private readonly kept = new Map<number, Uint8Array>();
  private ticks: number[] = []; // ascending
  private bytes = 0;

  constructor(private interval: number, private readonly mostBytes = 256e6) {}

  /** Whether the state of this tick should be kept. */
  wants(tick: number): boolean {
    return (this.kept.size === 0 || tick % this.interval === 0) && !this.kept.has(tick);
  }

  put(tick: number, state: Uint8Array): void {
    if (!this.wants(tick)) return;
    this.kept.set(tick, state);
    this.ticks.splice(this.indexBefore(tick) + 1, 0, tick);
    this.bytes += state.length;
    while (this.bytes > this.mostBytes && this.kept.size > 2) {
      this.interval *= 2;
      this.keepOnly((at) => at === this.ticks[0] || at % this.interval === 0);
    }
  }

  /** The last state at or before a tick. */
  before(tick: number): { tick: number; state: Uint8Array } | undefined {
    const at = this.ticks[this.indexBefore(tick)];
    return at === undefined ? undefined : { tick: at, state: this.kept.get(at)! };
  }

  /** Forgets the states after a tick: another future begins. */
  cut(tick: number): void {
    this.keepOnly((at) => at <= tick);
  }

  get size(): number {
    return this.kept.size;
  }

  // -1: all are later.
  private indexBefore(tick: number): number {
    let low = 0, high = this.ticks.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.ticks[middle]! <= tick) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  private keepOnly(stays: (tick: number) => boolean): void {
    for (const at of this.ticks.filter((one) => !stays(one))) {
      this.bytes -= this.kept.get(at)!.length;
      this.kept.delete(at);
    }
    this.ticks = this.ticks.filter((at) => this.kept.has(at));
  }
}
