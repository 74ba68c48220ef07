// The package's modules as one file, for the brief test: without vectors, and without the encryption, which is npm's.
import { type Lockstone, loadFrom } from "../src/load.js";

export * from "../src/full.js";
export { Client } from "../src/client.js";

export function loadSession(): Promise<Lockstone> {
  const plain = () => new URL("./lockstone-session.wasm", import.meta.url);
  return loadFrom({ simd: false }, plain, plain);
}
