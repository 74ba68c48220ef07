// The data that both sides of a SecureTransport's handshake share.
#pragma once

#include <cstdint>

#include <lockstone/net/keys.h>
#include <lockstone/net/transport.h>
#include <lockstone/net/transport_secure.h>

#include "net/security/secure_links.h"

namespace lockstone::net {

struct SecureData {
  Transport& carrier;
  RandomSource& secrets;
  SecureLinks links;
  SecurityCounters counters;
  std::int64_t now_us = 0;
};

}  // namespace lockstone::net
