// The server's side of the handshake: hello, challenge, confirm. After them both sides have proven
// that they hold the token's keys, and share fresh ones. docs/reference/wire-format.md has the
// bytes, docs/explanation/security.md the reasons.
#pragma once

#include <cstddef>
#include <optional>

#include <lockstone/bytes.h>
#include <lockstone/net/transport_secure.h>

#include "net/security/entry_limits.h"
#include "net/security/packet_seal.h"
#include "net/security/secure_data.h"
#include "net/security/token_seal.h"

namespace lockstone::net {

/// Judges tokens and proofs. Functions that take an event return whether it is to be told.
class SecureServerHandshake {
 public:
  SecureServerHandshake(SecureData& data, const SecureServerOptions& options)
      : data_(data), options_(options), entries_(options.max_connections) {}

  [[nodiscard]] bool on_hello(SecureLink& link, ByteView packet, TransportEvent& event);
  [[nodiscard]] bool on_confirm(SecureLink& link, ByteView packet, TransportEvent& event);

  /// An event that is to be told before anything else.
  [[nodiscard]] bool take_pending(TransportEvent& event);

  /// Ends handshakes that take too long. The session never hears of them.
  void expire();

 private:
  [[nodiscard]] bool hosts(std::uint64_t match) const;
  [[nodiscard]] RefuseReason judge(const SecureHello& hello, SealedGrant& grant) const;
  [[nodiscard]] bool challenge(SecureLink& link, const SecureHello& hello, const SealedGrant& grant,
                               ByteView packet, TransportEvent& event);
  void end_older_handshake(const SealedGrant& grant);
  [[nodiscard]] bool refuse(SecureLink& link, RefuseReason reason, TransportEvent& event);

  SecureData& data_;
  SecureServerOptions options_;
  EntryLimits entries_;
  std::optional<TransportEvent> pending_;
};

}  // namespace lockstone::net
