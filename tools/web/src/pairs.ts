import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import type { Lockstone } from "./load.js";
import { type Assets, type Shape, putShape } from "./shapes.js";
import { type Numbers3, type Quantity, type Rotation, type Vector, raw32 } from "./units.js";

/** A shape at a place, without a world. */
export interface PlacedShape {
  shape: Shape;
  position: Vector;
  orientation?: Rotation;
}

/** The closest points of A and B. */
export interface ShapeGap {
  /** m; 0 when they overlap. */
  distance: number;
  /** They share a point: then the points and the normal are zero. */
  overlapping: boolean;
  pointA: Numbers3;
  pointB: Numbers3;
  /** From A to B. */
  normal: Numbers3;
  /** Triangle, cell or child. */
  partA: number;
  partB: number;
}

/** When A and B meet. */
export interface ShapeHit {
  /** Of the way, 0 … 1. */
  fraction: number;
  /** At the start: the fraction is 0. */
  overlapping: boolean;
  /** On A's surface then. */
  point: Numbers3;
  /** From A to B; may be zero when they overlap. */
  normal: Numbers3;
  partA: number;
  partB: number;
}

/** A place to go to. */
export interface Place {
  position: Vector;
  orientation?: Rotation;
}

const A = 0; // places of arguments in heap.input
const B = c.lks_placed_shape.$bytes;
const END_A = 2 * B;
const END_B = END_A + c.lks_pose.$bytes;
const WAY = END_A;

function putPlace(heap: Heap, at: number, { position, orientation }: Place): number {
  heap.putVector64(at + c.lks_pose.position, position, c.LKS_POSITION_BITS);
  heap.putRotation(at + c.lks_pose.orientation, orientation ?? [0, 0, 0, 1]);
  return at;
}

function putPlaced(heap: Heap, at: number, placed: PlacedShape): number {
  putShape(heap, at + c.lks_placed_shape.shape, placed.shape);
  putPlace(heap, at + c.lks_placed_shape.pose, placed);
  return at;
}

/** Writes the shapes for a function that the module must have. */
function putPair(heap: Heap, name: Parameters<Heap["needs"]>[0], a: PlacedShape, b: PlacedShape): [a: number, b: number] {
  heap.needs(name);
  return [putPlaced(heap, heap.input + A, a), putPlaced(heap, heap.input + B, b)];
}

function hitOf(heap: Heap): ShapeHit | null {
  const at = heap.output, hit = c.lks_shape_hit;
  if (heap.getWord(at + hit.hit) === 0) return null;
  return {
    fraction: heap.get32(at + hit.fraction, c.LKS_UNIT_BITS),
    overlapping: heap.getWord(at + hit.overlapping) === 1,
    point: heap.getVector64(at + hit.point_a, c.LKS_POSITION_BITS),
    normal: heap.getVector32(at + hit.normal, c.LKS_UNIT_BITS),
    partA: heap.getWord(at + hit.part_a),
    partB: heap.getWord(at + hit.part_b),
  };
}

/**
 * The closest points of two shapes, of which one at least is a primitive, a hull or a compound; null where they are
 * farther apart than `reach`, 0 … 512 m. Error at most 2 µm. `assets` has those that the shapes name.
 */
export function shapeDistance({ heap }: Lockstone, a: PlacedShape, b: PlacedShape, reach: Quantity = 512, assets?: Assets): ShapeGap | null {
  const [first, second] = putPair(heap, "lks_shape_distance", a, b);
  const most = raw32(reach, c.LKS_LENGTH_BITS);
  heap.check(heap.f.lks_shape_distance(assets?.address ?? 0, first, second, most, heap.output));
  const at = heap.output, gap = c.lks_shape_gap;
  if (heap.getWord(at + gap.found) === 0) return null;
  return {
    distance: heap.get64(at + gap.distance, c.LKS_POSITION_BITS),
    overlapping: heap.getWord(at + gap.overlapping) === 1,
    pointA: heap.getVector64(at + gap.point_a, c.LKS_POSITION_BITS),
    pointB: heap.getVector64(at + gap.point_b, c.LKS_POSITION_BITS),
    normal: heap.getVector32(at + gap.normal, c.LKS_UNIT_BITS),
    partA: heap.getWord(at + gap.part_a),
    partB: heap.getWord(at + gap.part_b),
  };
}

/** Moves B, a primitive or a hull, along `way`, at most 512 m along each axis, without turning; A rests. Null where they do not meet. */
export function shapeCast({ heap }: Lockstone, a: PlacedShape, b: PlacedShape, way: Vector, assets?: Assets): ShapeHit | null {
  const [first, second] = putPair(heap, "lks_shape_cast", a, b);
  heap.putVector32(heap.input + WAY, way, c.LKS_LENGTH_BITS);
  heap.check(heap.f.lks_shape_cast(assets?.address ?? 0, first, second, heap.input + WAY, heap.output));
  return hitOf(heap);
}

/**
 * Moves both evenly to their ends, by the shortest turns, until they are as near as `gap`, 8 µm … 1 m, or 5/4 of it.
 * Primitives, hulls and compounds. Null where they do not come as near.
 */
export function shapeImpact({ heap }: Lockstone, a: PlacedShape, endA: Place, b: PlacedShape, endB: Place, gap: Quantity = 0.0005,
  assets?: Assets): ShapeHit | null {
  const [first, second] = putPair(heap, "lks_shape_impact", a, b);
  const [afterA, afterB] = [putPlace(heap, heap.input + END_A, endA), putPlace(heap, heap.input + END_B, endB)];
  const near = raw32(gap, c.LKS_LENGTH_BITS);
  heap.check(heap.f.lks_shape_impact(assets?.address ?? 0, first, afterA, second, afterB, near, heap.output));
  return hitOf(heap);
}
