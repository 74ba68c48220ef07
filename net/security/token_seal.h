// The part of a token that only backend and servers read.
#pragma once

#include <lockstone/net/token.h>

#include "net/security/crypto.h"

namespace lockstone::net {

/// The sealed part of a token, which only servers can read.
struct SealedGrant {
  TokenGrant grant;
  Key client_key;
  Key server_key;
};

/// The part of its token that a client shows; `sealed` points into the packet.
struct ShownToken {
  std::uint64_t match = 0;
  std::uint64_t expires_unix_s = 0;
  crypto::TokenNonce nonce{};
  ByteView sealed;  ///< k_token_sealed_bytes
};

/// checksum_mismatch: not sealed under this key, or altered; malformed: values out of range.
[[nodiscard]] Status open_sealed(const Key& backend_key, const ShownToken& token,
                                 SealedGrant& opened);

}  // namespace lockstone::net
