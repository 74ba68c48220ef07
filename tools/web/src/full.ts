import { type LoadOptions, Lockstone, loadFrom } from "./load.js";
import { World } from "./world.js";

export * from "./index.js";

/** As `load`, with the built-in scenes: a larger file. */
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
