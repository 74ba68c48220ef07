import * as c from "./declarations.js";
import { type LoadOptions, Lockstone, loadFrom } from "./load.js";
import { hex } from "./units.js";
import { World } from "./world.js";

export * from "./index.js";
export { type PlacedShape, type ShapeGap, type ShapeHit, shapeCast, shapeDistance, shapeImpact } from "./pairs.js";
export { Assets, assetShape, roundedBox, taperedCapsule } from "./shapes.js";
export { describeDifference } from "./state.js";

/**
 * As `load`, but everything that a world may have: assets, rounded boxes and tapered capsules, fluids, vehicles,
 * ragdolls and changes of terrain too, and the built-in scenes: a larger file.
 */
export function loadFull(options: LoadOptions = {}): Promise<Lockstone> {
  return loadFrom(options, () => new URL("./lockstone-full.wasm", import.meta.url),
    () => new URL("./lockstone-full-simd.wasm", import.meta.url));
}

/** The names of the built-in scenes. */
export function sceneNames({ heap }: Lockstone): string[] {
  return Array.from({ length: heap.f.lks_scene_count() }, (_, i) => heap.text(heap.f.lks_scene_name(i)));
}

/** A built-in scene, which plays by itself and takes no command: its hashes are known, so it checks a machine. */
export function createScene(lockstone: Lockstone, name: string, seed = 1n): World {
  const { heap } = lockstone;
  heap.check(heap.f.lks_world_create_scene(heap.putText(name), seed, heap.output));
  return new World(lockstone, {}, heap.getWord(heap.output));
}

/** The verdict on a log that was computed again. */
export interface LogReport {
  outcome: "same" | "diverged" | "corrupt" | "incompatible";
  startTick: number;
  ticksVerified: number;
  /** Of the last verified tick. */
  finalHash: string;
  /** Where it diverged: the first tick, the recorded hash and the own one. */
  divergence: { tick: number; expected: string; actual: string } | null;
  /** Whether the log's end was read. */
  complete: boolean;
  /** The log ends inside a chunk, as after a kill. */
  tornTail: boolean;
  /** For people. */
  line: string;
}

/** Computes a log of the arena or of a built-in scene again, and compares every hash. It must not be compressed (`lockstone record --plain`). */
export function verifyLog({ heap }: Lockstone, bytes: Uint8Array): LogReport {
  const report = c.lks_log_report;
  const at = heap.output;
  const room = heap.allocate(bytes.length);
  try {
    heap.u8.set(bytes, room);
    heap.putWord(at, report.$bytes);
    heap.check(heap.f.lks_verify_log_bytes(room, bytes.length, at));
  } finally {
    heap.f.free(room);
  }
  const number = (place: number) => Number(heap.getId(at + place));
  const outcome = (["same", "diverged", "corrupt", "incompatible"] as const)[heap.getWord(at + report.outcome)]!;
  const hashAt = (place: number) => hex(heap.getId(at + place));
  return {
    outcome,
    startTick: number(report.start_tick),
    ticksVerified: number(report.ticks_verified),
    finalHash: hashAt(report.final_hash),
    divergence: outcome !== "diverged" ? null : {
      tick: number(report.diverged_tick), expected: hashAt(report.expected), actual: hashAt(report.actual),
    },
    complete: heap.getWord(at + report.complete) === 1,
    tornTail: heap.getWord(at + report.torn_tail) === 1,
    line: heap.text(at + report.line),
  };
}
