// The hash of hash.h, inlined: for loops over thousands of records whose size is known. Each file
// that includes it holds a copy of XXH3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace lockstone {

/// As `hash64`.
template <std::size_t Size>
[[nodiscard]] inline std::uint64_t hash64_inline(std::span<const std::byte, Size> bytes,
                                                 std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace lockstone
