// The one hash of the project: XXH3, 64 bits or 128. It detects accidents (bit flips, torn writes,
// diverging states), not tampering.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace lockstone {

/// XXH3_64bits_withSeed of `bytes`. The same on every processor; `seed` separates domains.
/// Source: Yann Collet, xxHash 0.8, "XXH3".
[[nodiscard]] std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed = 0);

struct Hash128 {
  std::uint64_t low = 0;
  std::uint64_t high = 0;

  friend bool operator==(const Hash128&, const Hash128&) = default;
};

/// XXH3_128bits_withSeed, for where 64 bits might meet by chance: billions of states compared.
[[nodiscard]] Hash128 hash128(std::span<const std::byte> bytes, std::uint64_t seed = 0);

}  // namespace lockstone
