// X25519, for builds without libsodium. Source: RFC 7748 (Elliptic Curves for Security), section 5.
#pragma once

#include <lockstone/net/keys.h>

namespace lockstone::net::portable {

/// The secret times the point that `other` names. Takes the same time for all secrets.
[[nodiscard]] Key x25519(const Key& secret, const Key& other);

/// The point that all begin from.
[[nodiscard]] Key x25519_base();

}  // namespace lockstone::net::portable
