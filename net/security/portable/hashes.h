// BLAKE2b-256 and SipHash-2-4, for builds without libsodium. Sources: RFC 7693 (The BLAKE2
// Cryptographic Hash); J.-P. Aumasson, D. J. Bernstein, "SipHash: a fast short-input PRF", 2012.
#pragma once

#include <cstdint>
#include <initializer_list>

#include <lockstone/bytes.h>
#include <lockstone/net/keys.h>

namespace lockstone::net::portable {

/// Of the parts, one after the other, under a key.
[[nodiscard]] Key blake2b(const Key& key, std::initializer_list<ByteView> parts);

[[nodiscard]] std::uint64_t siphash(const LinkKey& key, ByteView bytes);

}  // namespace lockstone::net::portable
