import { Body, type BodyDef, putBodyDef } from "./body.js";
import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import type { Lockstone } from "./load.js";
import type { Assets } from "./shapes.js";
import { type Quantity, type Vector, hex } from "./units.js";

/** Capacities and rules of a world, fixed for its life. Fields that are left out have the library's defaults. */
export interface WorldDef {
  /** 1 … 2^20. */
  bodyCapacity?: number;
  /** Pairs with overlapping bounds, 1 … 2^24. */
  pairCapacity?: number;
  /** Touching pairs, 1 … 2^24. */
  contactCapacity?: number;
  /** 0 … 2^20. */
  jointCapacity?: number;
  /** Ticks per second, 10 … 480. */
  tickRate?: number;
  /** Solver steps a tick, 1 … 16. */
  substeps?: number;
  /** Rest before a body sleeps, ms; 0: none ever does. */
  sleepMs?: number;
  /** m: a body that moves less rests. */
  sleepDistance?: Quantity;
  /** Changes no result. */
  broadPhase?: "trees" | "sweep";
  /** m/s². */
  gravity?: Vector;
  /** m/s, of every body, 1 … 500. */
  speedLimit?: Quantity;
  /** Contacts of islands that are solved to convergence, 0 … 65,536; 0: none is. */
  convergedContacts?: number;
}

/** Counts of a step. The same on every peer. */
export type StepReport = { readonly [name in StepCount]: number };
type StepCount =
  | "status" | "movingBodies" | "asleepBodies" | "islands" | "freeBodies" | "axisTurns" | "pairs" | "contacts"
  | "contactPoints" | "colors" | "overflowContacts" | "continuousBodies" | "impacts" | "saturations" | "energyLimits"
  | "computedIslands" | "recalledIslands" | "stillBodies" | "stillContacts";

function camel(name: string): string {
  return name.replace(/_(.)/g, (_, letter: string) => letter.toUpperCase());
}

const def = c.lks_world_def;

/** Writes a definition to `heap.input`. */
export function putWorldDef(heap: Heap, from: WorldDef): number {
  const at = heap.input;
  heap.check(heap.f.lks_world_def_init(at, def.$bytes));
  const words = {
    body_capacity: from.bodyCapacity, pair_capacity: from.pairCapacity, contact_capacity: from.contactCapacity,
    joint_capacity: from.jointCapacity, tick_rate: from.tickRate, substeps: from.substeps, sleep_ms: from.sleepMs,
    converged_contacts: from.convergedContacts, broad_phase: from.broadPhase === "sweep" ? 1 : undefined,
  } as const;
  for (const [name, value] of Object.entries(words)) {
    if (value !== undefined) heap.putWord(at + def[name as keyof typeof words], value);
  }
  if (from.sleepDistance !== undefined) heap.put32(at + def.sleep_distance, from.sleepDistance, c.LKS_LENGTH_BITS);
  if (from.gravity) heap.putVector64(at + def.gravity, from.gravity, c.LKS_ACCELERATION_BITS);
  if (from.speedLimit !== undefined) heap.put64(at + def.speed_limit, from.speedLimit, c.LKS_VELOCITY_BITS);
  return at;
}

/** A hash over everything in the definition that can change a result, and the assets: peers compare it before they play. */
export function configHash(lockstone: Lockstone, definition: WorldDef = {}, assets?: Assets): string {
  const { heap } = lockstone;
  heap.check(heap.f.lks_config_hash(putWorldDef(heap, definition), assets?.address ?? 0, heap.output));
  return hex(heap.getId(heap.output));
}

/** Poses and names of all bodies by ascending index, in the module's memory: `World.poses` writes them again. */
export interface Poses {
  readonly count: number;
  /** The id of each body. */
  readonly bodies: BigUint64Array;
  /** Raw: `positions[5 * i + axis]` in 2^-32 m; the place of the shape's frame. */
  readonly positions: BigInt64Array;
  /** Raw: `orientations[10 * i + 6 + k]` in 2^-30, k = 0 … 3: x, y, z, w. */
  readonly orientations: Int32Array;
}

const forgotten = new FinalizationRegistry<() => void>((free) => free());

/** Memory of a world that is released with it. */
class Rooms {
  private readonly addresses: number[] = [];
  constructor(private readonly heap: Heap, private readonly world: number) {}

  allocate(bytes: number): number {
    const address = this.heap.allocate(bytes);
    this.addresses.push(address);
    return address;
  }

  release(): void {
    for (const address of this.addresses.splice(0)) this.heap.f.free(address);
    this.heap.f.lks_world_destroy(this.world);
  }
}

/** A world, or a built-in scene (`createScene`). */
export class World {
  readonly heap: Heap;
  readonly address: number;
  readonly bodyCapacity: number;
  readonly contactCapacity: number;
  readonly jointCapacity: number;
  readonly tickRate: number;
  private readonly rooms: Rooms;
  private lists: { bodies: number; poses: number } | undefined;

  /** `made`: a world that the C interface made, which this object destroys. */
  constructor(readonly lockstone: Lockstone, definition: WorldDef & { assets?: Assets } = {}, made?: number) {
    const heap = (this.heap = lockstone.heap);
    if (made === undefined) {
      const from = putWorldDef(heap, definition);
      heap.check(heap.f.lks_world_create(from, definition.assets?.address ?? 0, heap.output));
      made = heap.getWord(heap.output);
    }
    this.address = made;
    const rooms = (this.rooms = new Rooms(heap, made));
    forgotten.register(this, () => rooms.release(), this);
    heap.putWord(heap.output, def.$bytes);
    heap.check(heap.f.lks_world_get_def(made, heap.output));
    this.bodyCapacity = heap.getWord(heap.output + def.body_capacity);
    this.contactCapacity = heap.getWord(heap.output + def.contact_capacity);
    this.jointCapacity = heap.getWord(heap.output + def.joint_capacity);
    this.tickRate = heap.getWord(heap.output + def.tick_rate);
  }

  /** Releases the world's memory. Without it that happens some time after the object is forgotten. */
  destroy(): void {
    if (this.address === 0) return;
    forgotten.unregister(this);
    this.rooms.release();
    (this as { address: number }).address = 0;
  }

  /** Advances by 1 / tickRate seconds a tick. */
  step(ticks = 1): void {
    for (let i = 0; i < ticks; ++i) this.heap.check(this.heap.f.lks_step(this.address, 0));
  }

  /** Steps once, and tells of it. */
  stepWithReport(): StepReport {
    const { heap } = this;
    heap.putWord(heap.output, c.lks_step_report.$bytes);
    heap.check(heap.f.lks_step(this.address, heap.output));
    const { $bytes, size, ...places } = c.lks_step_report;
    return Object.fromEntries(
      Object.entries(places).map(([name, place]) => [camel(name), heap.getWord(heap.output + place)])) as StepReport;
  }

  /** Ticks stepped. */
  get tick(): number {
    const { heap } = this;
    heap.check(heap.f.lks_tick(this.address, heap.output));
    return Number(heap.getId(heap.output));
  }

  /** Over everything that can change the future, as sixteen hexadecimal digits. */
  get hash(): string {
    const { heap } = this;
    heap.check(heap.f.lks_hash(this.address, heap.output));
    return hex(heap.getId(heap.output));
  }

  createBody(definition: BodyDef): Body {
    const { heap } = this;
    putBodyDef(heap, definition);
    heap.check(heap.f.lks_create_body(this.address, heap.input, heap.output));
    return new Body(this, heap.getId(heap.output));
  }

  /** m/s². */
  setGravity(gravity: Vector): void {
    const { heap } = this;
    heap.putVector64(heap.input, gravity, c.LKS_ACCELERATION_BITS);
    heap.check(heap.f.lks_set_gravity(this.address, heap.input));
  }

  /** All bodies by ascending index. */
  bodies(): Body[] {
    return Array.from(this.poses().bodies, (id) => new Body(this, id));
  }

  /** Poses of all bodies as raw integers, without a copy: valid until the next call. `View` has poses to draw. */
  poses(): Poses {
    const { heap } = this;
    const { bodies, poses } = this.room();
    heap.check(heap.f.lks_bodies(this.address, bodies, poses, 0, this.bodyCapacity, heap.output));
    const count = heap.getWord(heap.output);
    return {
      count,
      bodies: heap.u64.subarray(bodies >>> 3, (bodies >>> 3) + count),
      positions: heap.i64.subarray(poses >>> 3, (poses >>> 3) + 5 * count),
      orientations: heap.i32.subarray(poses >>> 2, (poses >>> 2) + 10 * count),
    };
  }

  /** From here on the world remembers its last ticks, at most 256: a tick that is stepped again after a load costs as much as differs. */
  keepHistory(ticks: number): void {
    this.heap.check(this.heap.f.lks_world_keep_history(this.address, ticks));
  }

  forgetHistory(): void {
    this.heap.check(this.heap.f.lks_world_forget_history(this.address));
  }

  /** Memory that is released with the world. */
  allocate(bytes: number): number {
    return this.rooms.allocate(bytes);
  }

  private room(): { bodies: number; poses: number } {
    this.lists ??= {
      bodies: this.allocate(8 * this.bodyCapacity),
      poses: this.allocate(c.lks_pose.$bytes * this.bodyCapacity),
    };
    return this.lists;
  }
}
