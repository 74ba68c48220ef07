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

/** States by tick. When they hold more than their share of memory, every second one goes. */
export class History {
  private readonly kept = new Map<number, Uint8Array>();
  private bytes = 0;

  constructor(private interval: number, private readonly mostBytes = 256e6) {}

  /** Whether the state of this tick should be kept. */
  wants(tick: number): boolean {
    return tick % this.interval === 0 && !this.kept.has(tick);
  }

  put(tick: number, state: Uint8Array): void {
    if (this.kept.has(tick)) return;
    this.kept.set(tick, state);
    this.bytes += state.length;
    while (this.bytes > this.mostBytes && this.kept.size > 2) this.thin();
  }

  /** The last state at or before a tick. */
  before(tick: number): { tick: number; state: Uint8Array } | undefined {
    for (let at = tick - (tick % this.interval); at >= 0; at -= this.interval) {
      const state = this.kept.get(at);
      if (state) return { tick: at, state };
    }
    return undefined;
  }

  /** Forgets what comes after a tick: another future begins. */
  cut(tick: number): void {
    for (const [at, state] of this.kept) {
      if (at <= tick) continue;
      this.kept.delete(at);
      this.bytes -= state.length;
    }
  }

  get size(): number {
    return this.kept.size;
  }

  private thin(): void {
    this.interval *= 2;
    for (const [at, state] of this.kept) {
      if (at % this.interval === 0) continue;
      this.kept.delete(at);
      this.bytes -= state.length;
    }
  }
}
