#include <lockstone/random.h>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {

// The high word of bits · bound is the result, where the low word is at least 2^64 mod bound: so
// many products have each high word. (Daniel Lemire, "Fast random integer generation in an
// interval", 2019.)
std::uint64_t Random::below_word(std::uint64_t bound) {
  LKS_ASSERT(bound > 0);
  UInt128 product = multiply_wide(bits64(), bound);
  if (product.low >= bound) return product.high;
  const std::uint64_t excess = (0 - bound) % bound;  // 2^64 mod bound
  while (product.low < excess)
    product = multiply_wide(bits64(), bound);
  return product.high;
}

std::int64_t Random::between_words(std::int64_t low, std::int64_t high) {
  LKS_ASSERT(low <= high);
  if (low >= high) return low;
  const std::uint64_t count =
      static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low) + 1;
  const std::uint64_t steps = count == 0 ? bits64() : below_word(count);
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + steps);
}

Vec3<Unit> Random::direction() {
  constexpr std::uint64_t k_radius_squared = std::uint64_t{1} << 62;
  constexpr std::uint64_t k_least_squared = std::uint64_t{1} << 44;  // below, directions are few
  for (;;) {
    const random_detail::Block bits = block();
    const auto coordinate = [&](std::size_t i) { return static_cast<std::int32_t>(bits[i]); };
    const Vec3<Unit> point{Unit::from_raw(coordinate(0)), Unit::from_raw(coordinate(1)),
                           Unit::from_raw(coordinate(2))};
    const std::uint64_t square = norm_squared(point);
    if (square >= k_least_squared && square <= k_radius_squared) return direction_of(point);
  }
}

}  // namespace lockstone
