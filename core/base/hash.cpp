#include <lockstone/hash.h>

#include "core/base/inline_hash.h"

namespace lockstone {

std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed) {
  return hash64_inline(bytes, seed);
}

Hash128 hash128(std::span<const std::byte> bytes, std::uint64_t seed) {
  const XXH128_hash_t hash = XXH3_128bits_withSeed(bytes.data(), bytes.size(), seed);
  return {hash.low64, hash.high64};
}

}  // namespace lockstone
