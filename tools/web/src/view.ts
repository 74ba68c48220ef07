import * as c from "./declarations.js";
import type { Vector } from "./units.js";
import type { World } from "./world.js";

export interface ViewOptions {
  /** m: subtracted in integers, so that pictures are as steady far out as at 0. */
  origin?: Vector;
  /** m: a body that moved farther in a tick was teleported, and is shown at once. 10. */
  snapDistance?: number;
}

interface TickPoses {
  readonly struct: number;
  readonly bodies: number;
  readonly positions: number;
  readonly orientations: number;
}

/**
 * Poses to draw, in floating point, between the last two ticks: in arrays of the module's memory,
 * a row for each `Body.index`. Call `update` after every tick, and `at` in every frame.
 *
 * The arrays are new objects after the memory has grown: ask for them in every frame.
 */
export class View {
  private before: TickPoses;
  private now: TickPoses;
  private readonly shownPositions: number;
  private readonly shownOrientations: number;
  private readonly snapDistance: number;
  private readonly origin: number;
  private used = 0;
  private generation = 0;
  private arrays!: { positions: Float32Array; orientations: Float32Array };

  constructor(readonly world: World, { origin = [0, 0, 0], snapDistance = 10 }: ViewOptions = {}) {
    this.before = this.tickPoses();
    this.now = this.tickPoses();
    this.shownPositions = world.allocate(12 * world.bodyCapacity);
    this.shownOrientations = world.allocate(16 * world.bodyCapacity);
    this.origin = world.allocate(c.lks_i64x3.$bytes);
    this.snapDistance = snapDistance;
    this.moveOrigin(origin);
  }

  /** Rows 0 … count - 1 hold all bodies; rows between may be empty. */
  get count(): number {
    return this.used;
  }

  /** The id of the body of each row as of the last `update`; 0: the row is empty. */
  get bodies(): BigUint64Array {
    return new BigUint64Array(this.world.heap.f.memory.buffer, this.now.bodies, this.used);
  }

  /** `positions[3 * row + axis]`: m from the origin, as of the last `at`. */
  get positions(): Float32Array {
    return this.fresh().positions;
  }

  /** `orientations[4 * row + k]`: a unit quaternion x, y, z, w. */
  get orientations(): Float32Array {
    return this.fresh().orientations;
  }

  /** Takes the poses after a tick. */
  update(): void {
    [this.before, this.now] = [this.now, this.before];
    this.read();
  }

  /** Takes the poses after a load or a rollback: shown at once. */
  reset(): void {
    this.update();
    this.update();
  }

  /** m. The poses of the last tick are shown at once. */
  moveOrigin(origin: Vector): void {
    this.world.heap.putVector64(this.origin, origin, c.LKS_POSITION_BITS);
    this.reset();
  }

  /** Writes the poses of a part of the way from the tick before the last to the last, 0 … 1. */
  at(fraction: number): this {
    const { heap, address } = this.world;
    if (address === 0) throw new Error("the world of this view is destroyed");
    heap.f.lks_web_blend(this.before.struct, this.now.struct, Math.min(Math.max(fraction, 0), 1), this.snapDistance,
      this.used, this.shownPositions, this.shownOrientations);
    return this;
  }

  private read(): void {
    const { heap, address, bodyCapacity } = this.world;
    const { bodies, positions, orientations } = this.now;
    heap.check(
      heap.f.lks_web_poses(address, this.origin, bodies, positions, orientations, bodyCapacity, heap.output));
    this.used = heap.getWord(heap.output);
  }

  private tickPoses(): TickPoses {
    const { world } = this;
    const at = c.lks_web_poses_at;
    const poses = {
      struct: world.allocate(at.$bytes),
      bodies: world.allocate(8 * world.bodyCapacity),
      positions: world.allocate(12 * world.bodyCapacity),
      orientations: world.allocate(16 * world.bodyCapacity),
    };
    world.heap.putWord(poses.struct + at.bodies, poses.bodies);
    world.heap.putWord(poses.struct + at.positions, poses.positions);
    world.heap.putWord(poses.struct + at.orientations, poses.orientations);
    return poses;
  }

  private fresh(): typeof this.arrays {
    const { heap, bodyCapacity } = this.world;
    if (this.generation !== heap.generation) {
      const { buffer } = heap.f.memory;
      this.arrays = {
        positions: new Float32Array(buffer, this.shownPositions, 3 * bodyCapacity),
        orientations: new Float32Array(buffer, this.shownOrientations, 4 * bodyCapacity),
      };
      this.generation = heap.generation;
    }
    return this.arrays;
  }
}
