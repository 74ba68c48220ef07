import { LKS_C_ABI } from "./declarations.js";
import { type Exports, Heap } from "./heap.js";
import { hex } from "./units.js";

/** Where the WebAssembly comes from: an address, its bytes, the answer of a fetch, or a module that is compiled already. */
export type WasmSource = string | URL | BufferSource | WebAssembly.Module | Response | PromiseLike<Response>;

export interface LoadOptions {
  /** Vectors or not. Without it: vectors where the engine has them. Changes no result. */
  simd?: boolean;
  /** Instead of the file beside this module, for instance from a content delivery network. */
  wasm?: WasmSource;
}

/** The library, loaded. Worlds of one are used by one thread; load another one in a worker. */
export class Lockstone {
  /** Memory and functions of the module, for programs that call the C interface themselves. */
  readonly heap: Heap;

  constructor(
    exports: Exports,
    /** Whether it computes with vectors. */
    readonly simd: boolean,
  ) {
    this.heap = new Heap(exports);
    const abi = exports.lks_c_abi();
    if (abi !== LKS_C_ABI) throw new Error(`the WebAssembly has the ABI ${abi}, this package needs ${LKS_C_ABI}`);
  }

  /** "0.1.0". */
  get version(): string {
    return this.heap.text(this.heap.f.lks_version());
  }

  /** Changes whenever the same commands may give another state: peers of a match must agree on it. */
  get simulationAbi(): number {
    return this.heap.f.lks_simulation_abi() >>> 0;
  }

  /** This build's hash of a short built-in scene, as text. Peers must agree on it too. */
  get canaryHash(): string {
    return hex(this.heap.f.lks_canary_hash());
  }
}

/** Whether the engine has WebAssembly's vectors. */
export function hasSimd(): boolean {
  // (module (func (drop (i8x16.splat (i32.const 0)))))
  const bytes = [0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 9, 1, 7, 0, 65, 0, 253, 15, 26, 11];
  return WebAssembly.validate(new Uint8Array(bytes));
}

/**
 * Loads the library: worlds of spheres, capsules, boxes, cylinders, cones and half-spaces, joints, queries, events,
 * snapshots. `loadFull` of `lockstone/full` has the rest.
 */
export function load(options: LoadOptions = {}): Promise<Lockstone> {
  return loadFrom(options, () => new URL("./lockstone.wasm", import.meta.url),
    () => new URL("./lockstone-simd.wasm", import.meta.url));
}

/** Functions that a module imports. `heap`: once it is loaded. */
export type Imported = (heap: () => Heap) => Record<string, (...values: number[]) => number | void>;

/** Loads one of two files. `more`: what it imports beside the system's functions, by modules. */
export async function loadFrom(options: LoadOptions, plain: () => URL, vectors: () => URL,
  more: Record<string, Imported> = {}): Promise<Lockstone> {
  const simd = options.simd ?? hasSimd();
  let heap: Heap | undefined;
  const imports = importsOf(() => heap, more);
  const instance = await instantiate(options.wasm ?? (simd ? vectors() : plain()), imports);
  const loaded = new Lockstone(instance.exports as unknown as Exports, simd);
  heap = loaded.heap;
  return loaded;
}

/** The imports of the module: it needs next to nothing. `heap`: once it is loaded. */
function importsOf(heap: () => Heap | undefined, more: Record<string, Imported>): WebAssembly.Imports {
  const fail = (): never => {
    throw new Error("Lockstone: a fault of the library; please report it");
  };
  const named: Record<string, (...values: number[]) => unknown> = {
    emscripten_notify_memory_growth: () => heap()?.refresh(),
    // Secrets of a match's connection.
    getentropy: (address = 0, bytes = 0) => {
      globalThis.crypto.getRandomValues(new Uint8Array(heap()!.f.memory.buffer as ArrayBuffer, address, bytes));
      return 0;
    },
  };
  // No files, no clock, no output: a call of any other import is a fault.
  const any = new Proxy(named, { get: (known, name) => known[name as string] ?? fail });
  const others = Object.fromEntries(Object.entries(more).map(([name, imported]) => [name, imported(() => heap()!)]));
  return new Proxy(others, { get: (known, module) => known[module as string] ?? any }) as WebAssembly.Imports;
}

async function instantiate(source: WasmSource, imports: WebAssembly.Imports): Promise<WebAssembly.Instance> {
  const code = await (typeof source === "string" || source instanceof URL ? open(source) : source);
  if (typeof Response === "function" && code instanceof Response) return fromResponse(code, imports);
  if (code instanceof WebAssembly.Module) return WebAssembly.instantiate(code, imports);
  return (await WebAssembly.instantiate(code as BufferSource, imports)).instance;
}

async function fromResponse(response: Response, imports: WebAssembly.Imports): Promise<WebAssembly.Instance> {
  if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
  // Compiled while it arrives, where the server names the type right.
  const streams = response.headers.get("content-type")?.startsWith("application/wasm");
  if (streams) return (await WebAssembly.instantiateStreaming(response, imports)).instance;
  return (await WebAssembly.instantiate(await response.arrayBuffer(), imports)).instance;
}

/** The file of an address. Node's fetch knows no files. */
async function open(address: string | URL): Promise<Response | BufferSource> {
  if (new URL(address, import.meta.url).protocol !== "file:") return fetch(address);
  const files = "node:fs/promises";
  const { readFile } = await import(/* @vite-ignore */ /* webpackIgnore: true */ files);
  return readFile(new URL(address, import.meta.url));
}
