// What a person does to a world: whole numbers, so that a link repeats it bit for bit.
import type { Heap } from "../../web/src/heap.js";

export const Kind = { pull: 0, spawn: 1, remove: 2, push: 3 } as const;
export type Triple = readonly [number, number, number];

/** As lks_studio_action; lengths in 2^-20 m for `size`, else 2^-32 m and m/s. */
export interface Action {
  kind: number;
  body: bigint;
  shape: number;
  size: bigint;
  point: bigint[];
  place: bigint[];
  speed: bigint[];
}

const ZERO = [0n, 0n, 0n];

/** Raw fixed-point numbers of metres. */
export function raw32(v: Triple): bigint[] {
  return v.map((x) => BigInt(Math.round(x * 2 ** 32)));
}

export function pull(body: bigint, point: Triple, place: Triple): Action {
  return { kind: Kind.pull, body, shape: 0, size: 0n, point: raw32(point), place: raw32(place), speed: ZERO };
}
export function spawn(shape: number, size: number, place: Triple, speed: Triple): Action {
  const raw = BigInt(Math.round(size * 2 ** 20));
  return { kind: Kind.spawn, body: 0n, shape, size: raw, point: ZERO, place: raw32(place), speed: raw32(speed) };
}
export function push(body: bigint, speed: Triple): Action {
  return { kind: Kind.push, body, shape: 0, size: 0n, point: ZERO, place: ZERO, speed: raw32(speed) };
}
export function remove(body: bigint): Action {
  return { kind: Kind.remove, body, shape: 0, size: 0n, point: ZERO, place: ZERO, speed: ZERO };
}

export function numbersOf(action: Action): bigint[] {
  const { kind, body, shape, size, point, place, speed } = action;
  return [BigInt(kind), BigInt.asIntN(64, body), BigInt(shape), size, ...point, ...place, ...speed];
}

export function actionOf(numbers: readonly bigint[]): Action {
  const [kind = 0n, body = 0n, shape = 0n, size = 0n] = numbers;
  const three = (from: number) => [0, 1, 2].map((i) => numbers[from + i] ?? 0n);
  return {
    kind: Number(kind), body: BigInt.asUintN(64, body), shape: Number(shape), size,
    point: three(4), place: three(7), speed: three(10),
  };
}

/** Writes the structure to `heap.input`. */
export function putAction(heap: Heap, action: Action): number {
  numbersOf(action).forEach((number, i) => (heap.i64[(heap.input >>> 3) + i] = number));
  return heap.input;
}
