/**
 * Lockstone with matches: a browser tab plays beside native clients, in lockstep or with rollback.
 *
 * @packageDocumentation
 */
import { cryptoImports } from "./crypto.js";
import { type LoadOptions, Lockstone, loadFrom } from "./load.js";

export * from "./full.js";
export {
  Ask, Client, type ClientOptions, type ClientState, type ClientStats, type FinishReason, type SessionEvent,
  type WebSocketLike,
} from "./client.js";
export { Recording } from "./recording.js";

/** As `loadFull`, with the client of matches: a larger file. */
export function loadSession(options: LoadOptions = {}): Promise<Lockstone> {
  return loadFrom(options, () => new URL("./lockstone-session.wasm", import.meta.url),
    () => new URL("./lockstone-session-simd.wasm", import.meta.url), { lockstone_crypto: cryptoImports });
}
