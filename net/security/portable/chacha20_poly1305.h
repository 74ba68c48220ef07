// ChaCha20-Poly1305 and its form with a long nonce, for builds without libsodium.
// Sources: RFC 8439 (ChaCha20 and Poly1305 for IETF Protocols); draft-irtf-cfrg-xchacha-03.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/net/keys.h>

namespace lockstone::net::portable {

/// `out` has 16 bytes more than `plain`; 12 bytes of nonce, or 24.
void seal(const Key& key, ByteView nonce, ByteView context, ByteView plain,
          std::span<std::byte> out);

/// False, and zeros in `out`, if a bit was changed or the key is another.
[[nodiscard]] bool open(const Key& key, ByteView nonce, ByteView context, ByteView sealed,
                        std::span<std::byte> out);

}  // namespace lockstone::net::portable
