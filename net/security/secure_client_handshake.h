// The client's side of the handshake: it sends its token, and answers the server's challenge.
#pragma once

#include <lockstone/bytes.h>
#include <lockstone/net/token.h>

#include "net/security/packet_seal.h"
#include "net/security/secure_data.h"

namespace lockstone::net {

/// Proves that this side holds the token's key, and asks the same of the server. Functions return
/// whether there is an event to tell.
class SecureClientHandshake {
 public:
  SecureClientHandshake(SecureData& data, const ConnectToken& token) : data_(data), token_(token) {}

  /// A connection is there: says hello.
  [[nodiscard]] bool greet(SecureLink& link, TransportEvent& event);

  [[nodiscard]] bool on_challenge(SecureLink& link, ByteView packet, TransportEvent& event);

 private:
  SecureData& data_;
  ConnectToken token_;
};

}  // namespace lockstone::net
