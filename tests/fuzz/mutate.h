// Damages bytes as a fuzzer does.
#pragma once

#include <span>

#include "tests/fuzz/target.h"
#include "tests/support/random.h"

namespace lockstone::fuzz {

/// No result is longer.
inline constexpr std::size_t k_max_bytes = std::size_t{1} << 16;

/// One to eight changes: bits, bytes, extreme words, parts cut out, doubled, moved, or taken from
/// `other`.
void mutate(Bytes& bytes, std::span<const std::byte> other, test::Random& random);

}  // namespace lockstone::fuzz
