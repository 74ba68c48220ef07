// The cryptography of the session's WebAssembly, by the audited libraries `@noble`. The same
// bits as libsodium's, which native builds use.
import { chacha20poly1305, xchacha20poly1305 } from "@noble/ciphers/chacha.js";
import { x25519 } from "@noble/curves/ed25519.js";
import { blake2b } from "@noble/hashes/blake2.js";
import type { Heap } from "./heap.js";
import type { Imported } from "./load.js";

const KEY_BYTES = 32;
const PACKET_NONCE_BYTES = 12;
const TAG_BYTES = 16;

/** The functions that net/security/crypto_host.cpp imports. `heap`: once the module is loaded. */
export const cryptoImports: Imported = (heap: () => Heap) => {
  const copy = (address = 0, size = KEY_BYTES): Uint8Array => heap().u8.slice(address, address + size);
  const put = (address: number, bytes: Uint8Array): void => heap().u8.set(bytes, address);
  const cipher = (key: number, nonce: number, nonceSize: number, context: number, contextSize: number) => {
    const method = nonceSize === PACKET_NONCE_BYTES ? chacha20poly1305 : xchacha20poly1305;
    return method(copy(key), copy(nonce, nonceSize), copy(context, contextSize));
  };
  return {
    seal: (key, nonce, nonceSize, context, contextSize, plain, size, out) =>
      put(out!, cipher(key!, nonce!, nonceSize!, context!, contextSize!).encrypt(copy(plain, size))),
    open: (key, nonce, nonceSize, context, contextSize, sealed, size, out) => {
      if (size! < TAG_BYTES) return 0;
      try {
        put(out!, cipher(key!, nonce!, nonceSize!, context!, contextSize!).decrypt(copy(sealed, size)));
        return 1;
      } catch {
        return 0; // the seal is wrong
      }
    },
    keyed_hash: (key, bytes, size, out) => put(out!, blake2b(copy(bytes, size), { key: copy(key), dkLen: KEY_BYTES })),
    public_half: (secret, out) => put(out!, x25519.getPublicKey(copy(secret))),
    agree: (secret, otherHalf, out) => {
      try {
        put(out!, x25519.getSharedSecret(copy(secret), copy(otherHalf)));
        return 1;
      } catch {
        return 0; // the other half gives everybody zero
      }
    },
  };
};
