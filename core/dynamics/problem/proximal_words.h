// Ranges, and sums over rows and bodies, for the parts of the proximal solver.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <lockstone/fixed.h>

#include "core/dynamics/problem/body_factor.h"
#include "core/kernels/proximal/proximal_block.h"

namespace lockstone::proximal {

inline constexpr std::int64_t k_whole = std::int64_t{1} << 30;

[[nodiscard]] inline std::int64_t within_units(std::int64_t x) {
  return std::clamp(x, -lanes::k_most_unit, lanes::k_most_unit);
}

/// Clamps a quantity that a row keeps between phases; kernels keep speeds within a quarter of it.
[[nodiscard]] inline std::int64_t within_row(std::int64_t x) {
  constexpr std::int64_t k_most = std::int64_t{1} << 60;
  return std::clamp(x, -k_most, k_most);
}

/// As `within_units`, and notes when it had to.
class Clamp {
 public:
  std::int64_t operator()(std::int64_t x) {
    const std::int64_t result = within_units(x);
    hit_ = hit_ || result != x;
    return result;
  }
  [[nodiscard]] bool hit() const { return hit_; }

 private:
  bool hit_ = false;
};

/// Returns whether nothing had to be clamped.
[[nodiscard]] inline bool clamp_all(std::span<BodyVector> sums) {
  std::int64_t bits = 0;
  for (const BodyVector& sum : sums)
    for (const std::int64_t x : sum)
      bits |= x ^ (x >> 63);
  if (bits < lanes::k_most_unit) return true;
  Clamp clamp;
  for (BodyVector& sum : sums)
    for (std::int64_t& x : sum)
      x = clamp(x);
  return !clamp.hit();
}

}  // namespace lockstone::proximal
