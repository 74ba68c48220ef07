// The studio's WebAssembly: the npm package's classes over it, and its own functions.
import type { Exports, Heap } from "../../web/src/heap.js";
import { type Imported, type Lockstone, loadFrom } from "../../web/src/load.js";
import { World } from "../../web/src/world.js";

/** Functions of tools/studio/native/lockstone_studio.h. */
interface StudioFunctions {
  lks_studio_scene(name: number, seed: bigint, values: number, count: number, out: number): number;
  lks_studio_scene_parameter(scene: number, index: number, out: number): number;
  lks_studio_scene_text(index: number): number;
  lks_studio_act(world: number, action: number): number;
  lks_studio_draw(world: number, wanted: number, lists: number): number;
  lks_studio_measure(world: number, out: number): number;
  lks_studio_described_world(bytes: number, count: number, out: number): number;
  lks_studio_watch_stages(world: number): number;
  lks_studio_stage_times(world: number, sums: number): number;
  lks_studio_compare(a: number, b: number, list: number, differing: number): number;
  lks_studio_log_open(bytes: number, count: number, out: number): number;
  lks_studio_log_close(log: number): void;
  lks_studio_log_describe(log: number, out: number): number;
  lks_studio_log_text(log: number, which: number, index: number, text: number, capacity: number): number;
  lks_studio_log_world(log: number, out: number): number;
  lks_studio_log_keyframe(log: number, index: number, world: number): number;
  lks_studio_log_step(log: number, world: number, same: number): number;
}

/** Figures of a world after a step. */
export interface Figures {
  kinetic: number;
  potential: number;
  bodies: number;
  awake: number;
  asleep: number;
  contacts: number;
  points: number;
  islands: number;
  joints: number;
}

/** A whole number that a scene can be made with. */
export interface SceneParameter {
  name: string;
  /** In the scene of the golden hashes. */
  usual: number;
  least: number;
  most: number;
}

/** Bits of `draw`, and the numbers that an item of each list has. */
export const Drawn = { bodies: 1, bounds: 2, masses: 4, contacts: 8, joints: 16 } as const;
export const STRIDE = { bodies: 4, bounds: 7, masses: 14, contacts: 10, joints: 12 } as const;
export type Lists = { [name in keyof typeof STRIDE]: Float32Array };

/** States of the list `bodies`. */
export const State = { fixed: 0, kinematic: 1, awake: 2, asleep: 3, trigger: 4 } as const;

/** Stages of a tick: StepStage of lockstone/profile.h. */
export const STAGES = ["find_pairs", "collide", "prepare", "solve", "store", "move", "continuous", "refresh", "events", "sleep"] as const;

const FIGURES = ["bodies", "awake", "asleep", "contacts", "points", "islands", "joints"] as const;
const LIST_NAMES = ["bodies", "bounds", "masses", "contacts", "joints"] as const;

export class Engine {
  readonly heap: Heap;
  readonly f: Exports & StudioFunctions;

  private constructor(readonly lockstone: Lockstone, readonly module: WebAssembly.Module) {
    this.heap = lockstone.heap;
    this.f = this.heap.f as Exports & StudioFunctions;
  }

  /** `module` may be that of an engine of another thread. `crypto`: for matches that run; without it the module can do all but connect. */
  static async load(module: WebAssembly.Module, crypto?: Imported): Promise<Engine> {
    const never = (): URL => {
      throw new Error("the module is there");
    };
    const studio: Imported = () => ({ now: () => performance.now() });
    const more: Record<string, Imported> = { lockstone_studio: studio, ...(crypto ? { lockstone_crypto: crypto } : {}) };
    return new Engine(await loadFrom({ simd: true, wasm: module }, never, never, more), module);
  }

  sceneNames(): string[] {
    return Array.from({ length: this.f.lks_scene_count() }, (_, i) => this.heap.text(this.f.lks_scene_name(i)));
  }
  sceneText(index: number): string {
    return this.heap.text(this.f.lks_studio_scene_text(index));
  }

  /** Of a scene by its name. */
  sceneParameters(name: string): SceneParameter[] {
    const { heap } = this, scene = this.sceneNames().indexOf(name);
    const list: SceneParameter[] = [];
    while (scene >= 0 && this.f.lks_studio_scene_parameter(scene, list.length, heap.output) === 0) {
      const [usual, least, most] = heap.i32.subarray(heap.output / 4 + 1);
      list.push({ name: heap.text(heap.getWord(heap.output)), usual: usual!, least: least!, most: most! });
    }
    return list;
  }

  /** A scene that takes actions. `values`: of its parameters, all or none. */
  scene(name: string, seed: bigint, values: readonly number[]): World {
    const { heap } = this, room = heap.output + 8;
    heap.i32.set(values, room / 4);
    heap.check(this.f.lks_studio_scene(heap.putText(name), seed, room, values.length, heap.output));
    return this.world(heap.getWord(heap.output));
  }

  /** A world that the module made. */
  world(address: number): World {
    return new World(this.lockstone, {}, address);
  }

  /** An empty world that takes the states of a game's. */
  describedWorld(description: Uint8Array): World {
    const { heap } = this;
    const bytes = heap.allocate(description.length);
    try {
      heap.u8.set(description, bytes);
      heap.check(this.f.lks_studio_described_world(bytes, description.length, heap.output));
      return this.world(heap.getWord(heap.output));
    } finally {
      heap.f.free(bytes);
    }
  }

  /** Lists of numbers in the module's memory, until the next call. */
  draw(world: World, wanted: number): Lists {
    const { heap } = this;
    heap.check(this.f.lks_studio_draw(world.address, wanted, heap.output));
    const at = (i: number) => this.floats(heap.output + 8 * i);
    return Object.fromEntries(LIST_NAMES.map((name, i) => [name, at(i)])) as Lists;
  }

  measure(world: World): Figures {
    const { heap } = this;
    heap.check(this.f.lks_studio_measure(world.address, heap.output));
    const [kinetic, potential] = new Float64Array(heap.f.memory.buffer, heap.output, 2);
    const counts = FIGURES.map((name, i) => [name, heap.getWord(heap.output + 16 + 4 * i)]);
    return { kinetic, potential, ...Object.fromEntries(counts) } as Figures;
  }

  /** Begins to take stage times of a world. */
  watchStages(world: World): void {
    this.heap.check(this.f.lks_studio_watch_stages(world.address));
  }

  /** Of each stage, summed over all steps, ms. */
  stageTimes(world: World): Float64Array {
    const { heap } = this;
    const room = heap.output; // has room for the figures of a body, which are more
    heap.check(this.f.lks_studio_stage_times(world.address, room));
    return new Float64Array(heap.f.memory.buffer, room, STAGES.length).map((us) => us / 1000);
  }

  /** Four numbers a row: flags, m, m/s, degrees. */
  compare(a: World, b: World): { rows: Float32Array; differing: number } {
    const { heap } = this;
    heap.check(this.f.lks_studio_compare(a.address, b.address, heap.output, heap.output + 8));
    return { rows: this.floats(heap.output), differing: heap.getWord(heap.output + 8) };
  }

  private floats(list: number): Float32Array {
    const { heap } = this;
    return new Float32Array(heap.f.memory.buffer, heap.getWord(list), heap.getWord(list + 4));
  }
}
