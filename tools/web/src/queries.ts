import { Body } from "./body.js";
import * as c from "./declarations.js";
import type { Heap } from "./heap.js";
import { listAll } from "./list.js";
import { type Shape, putShape } from "./shapes.js";
import type { Numbers3, Quantity, Rotation, Vector } from "./units.js";
import type { World } from "./world.js";

/** Which bodies a query sees; without one, all but triggers. */
export interface QueryFilter {
  /** Categories. */
  mask?: number;
  ignore?: Body;
  triggers?: boolean;
  /** Only bodies whose own tag is `tag` in these bits; 0: of any tag. */
  tagMask?: number;
  tag?: number;
  /** At most 16 bodies to leave out; with `onlyListed` the only ones to look at. */
  bodies?: readonly Body[];
  onlyListed?: boolean;
}

/** Where a ray or a shape on its way first meets a body. */
export interface Hit {
  body: Body;
  /** Of the way, 0 … 1. */
  fraction: number;
  /** Of the body, outward; zero when a ray starts inside. */
  normal: Numbers3;
  point: Numbers3;
  /** Of the body's asset: triangle, cell or child. */
  part: number;
}

/** The nearest point of a body. */
export interface Closest {
  body: Body;
  point: Numbers3;
  /** m; 0 inside. */
  distance: number;
  part: number;
}

const START = 32; // places of arguments in heap.input
const WAY = 80;
const SHAPE = 96;
const FILTER = 128;

/** Writes a filter; its address, 0 for none. */
function putFilter(heap: Heap, from: QueryFilter | undefined): number {
  if (!from) return 0;
  const at = heap.input + FILTER;
  const filter = c.lks_query_filter;
  heap.check(heap.f.lks_query_filter_init(at, filter.$bytes));
  if (from.mask !== undefined) heap.putWord(at + filter.mask, from.mask);
  if (from.ignore) heap.u64[(at + filter.ignore) >>> 3] = from.ignore.id;
  if (from.triggers) heap.putWord(at + filter.triggers, 1);
  if (from.tagMask !== undefined) heap.putWord(at + filter.tag_mask, from.tagMask);
  if (from.tag !== undefined) heap.putWord(at + filter.tag, from.tag);
  if (from.onlyListed) heap.putWord(at + filter.only_listed, 1);
  const listed = from.bodies ?? [];
  heap.putWord(at + filter.listed_count, listed.length);
  listed.slice(0, c.LKS_FILTER_BODIES).forEach((body, i) => {
    heap.u64[((at + filter.listed) >>> 3) + i] = body.id;
  });
  return at;
}

function putRay(heap: Heap, origin: Vector, way: Vector): [origin: number, way: number] {
  heap.putVector64(heap.input + START, origin, c.LKS_POSITION_BITS);
  heap.putVector32(heap.input + WAY, way, c.LKS_LENGTH_BITS);
  return [heap.input + START, heap.input + WAY];
}

function putPlaced(heap: Heap, shape: Shape, position: Vector, orientation: Rotation): [shape: number, pose: number] {
  putShape(heap, heap.input + SHAPE, shape);
  heap.putVector64(heap.input + START, position, c.LKS_POSITION_BITS);
  heap.putRotation(heap.input + START + c.lks_pose.orientation, orientation);
  return [heap.input + SHAPE, heap.input + START];
}

function hitAt(world: World, at: number): Hit {
  const { heap } = world;
  const hit = c.lks_hit;
  return {
    body: new Body(world, heap.getId(at + hit.body)),
    fraction: heap.get32(at + hit.fraction, c.LKS_UNIT_BITS),
    normal: heap.getVector32(at + hit.normal, c.LKS_UNIT_BITS),
    point: heap.getVector64(at + hit.point, c.LKS_POSITION_BITS),
    part: heap.getWord(at + hit.part),
  };
}

function firstHit(world: World): Hit | null {
  return world.heap.getId(world.heap.output) === 0n ? null : hitAt(world, world.heap.output);
}

/** The first body along a ray, or null. The way is at most 512 m along each axis. */
export function castRay(world: World, origin: Vector, way: Vector, filter?: QueryFilter): Hit | null {
  const { heap } = world;
  heap.check(heap.f.lks_cast_ray(world.address, ...putRay(heap, origin, way), putFilter(heap, filter), heap.output));
  return firstHit(world);
}

/** Every body along a ray, nearest first. */
export function castRayAll(world: World, origin: Vector, way: Vector, filter?: QueryFilter): Hit[] {
  const { heap } = world;
  const ray = putRay(heap, origin, way);
  const seen = putFilter(heap, filter);
  return listAll(heap, c.lks_hit.$bytes, (...to) => heap.f.lks_cast_ray_all(world.address, ...ray, seen, ...to),
    (at) => hitAt(world, at));
}

/** Whether anything is in the way of a ray. */
export function isRayBlocked(world: World, origin: Vector, way: Vector, filter?: QueryFilter): boolean {
  const { heap } = world;
  heap.check(
    heap.f.lks_is_ray_blocked(world.address, ...putRay(heap, origin, way), putFilter(heap, filter), heap.output));
  return heap.getWord(heap.output) === 1;
}

/** The first body that a sphere, capsule, box or hull meets on its way, or null. */
export function castShape(world: World, shape: Shape, position: Vector, way: Vector,
  orientation: Rotation = [0, 0, 0, 1], filter?: QueryFilter): Hit | null {
  const { heap } = world;
  const placed = putPlaced(heap, shape, position, orientation);
  heap.putVector32(heap.input + WAY, way, c.LKS_LENGTH_BITS);
  heap.check(
    heap.f.lks_cast_shape(world.address, ...placed, heap.input + WAY, putFilter(heap, filter), heap.output));
  return firstHit(world);
}

/** Bodies that overlap a sphere, by ascending index. */
export function overlapSphere(world: World, centre: Vector, radius: Quantity, filter?: QueryFilter): Body[] {
  const { heap } = world;
  const at = heap.input + START;
  heap.putVector64(at, centre, c.LKS_POSITION_BITS);
  heap.put32(heap.input + WAY, radius, c.LKS_LENGTH_BITS);
  const raw = heap.i32[(heap.input + WAY) >>> 2]!;
  const seen = putFilter(heap, filter);
  return listAll(heap, 8, (...to) => heap.f.lks_overlap_sphere(world.address, at, raw, seen, ...to),
    (found) => new Body(world, heap.getId(found)));
}

/** Bodies that overlap a sphere, capsule, box or hull, by ascending index. */
export function overlapShape(world: World, shape: Shape, position: Vector, orientation: Rotation = [0, 0, 0, 1],
  filter?: QueryFilter): Body[] {
  const { heap } = world;
  const placed = putPlaced(heap, shape, position, orientation);
  const seen = putFilter(heap, filter);
  return listAll(heap, 8, (...to) => heap.f.lks_overlap_shape(world.address, ...placed, seen, ...to),
    (found) => new Body(world, heap.getId(found)));
}

/** Bodies whose bounds along the world's axes overlap the box from `lower` to `upper`, by ascending index: no shape is looked at. */
export function bodiesInBox(world: World, lower: Vector, upper: Vector, filter?: QueryFilter): Body[] {
  const { heap } = world;
  const [low, high] = [heap.input + START, heap.input + SHAPE];
  heap.putVector64(low, lower, c.LKS_POSITION_BITS);
  heap.putVector64(high, upper, c.LKS_POSITION_BITS);
  const seen = putFilter(heap, filter);
  return listAll(heap, 8, (...to) => heap.f.lks_bodies_in_box(world.address, low, high, seen, ...to),
    (found) => new Body(world, heap.getId(found)));
}

/** The nearest point of any body within `reach`, 0 … 512 m, or null. */
export function closestPoint(world: World, point: Vector, reach: Quantity, filter?: QueryFilter): Closest | null {
  const { heap } = world;
  heap.putVector64(heap.input + START, point, c.LKS_POSITION_BITS);
  heap.put32(heap.input + WAY, reach, c.LKS_LENGTH_BITS);
  const raw = heap.i32[(heap.input + WAY) >>> 2]!;
  heap.check(
    heap.f.lks_closest_point(world.address, heap.input + START, raw, putFilter(heap, filter), heap.output));
  const at = heap.output;
  const closest = c.lks_closest;
  const id = heap.getId(at + closest.body);
  if (id === 0n) return null;
  return {
    body: new Body(world, id),
    point: heap.getVector64(at + closest.point, c.LKS_POSITION_BITS),
    distance: heap.get32(at + closest.distance, c.LKS_LENGTH_BITS),
    part: heap.getWord(at + closest.part),
  };
}
