// Ranges, and products of rows and bodies, for the parts of the proximal solver.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <lockstone/fixed.h>

#include "core/dynamics/proximal_rows.h"

namespace lockstone::proximal {

inline constexpr std::int64_t k_whole = std::int64_t{1} << 30;

/// Quantities of a phase lie within ±this, in its units.
inline constexpr std::int64_t k_most_value = (std::int64_t{1} << 31) - 1;

[[nodiscard]] inline std::int64_t within_units(std::int64_t x) {
  return std::clamp(x, -k_most_value, k_most_value);
}

/// Clamps a quantity that a row keeps between phases.
[[nodiscard]] inline std::int64_t within_row(std::int64_t x) {
  constexpr std::int64_t k_most = std::int64_t{1} << 58;
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

/// Q30, of vectors that are within ±2^31: |row| ≤ 1, so the sum fits.
[[nodiscard]] inline std::int64_t row_dot(const RowSide& j, const BodyVector& u) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 6; ++i)
    sum += j[i] * u[i];
  return sum;
}

[[nodiscard]] inline std::int64_t row_speed(const ProximalRow& row, const BodyVector& a,
                                            const BodyVector& b) {
  return raw::round_shift(row_dot(row.a, a) + row_dot(row.b, b), 30);
}

inline void add_to(BodyVector& u, const RowSide& j, std::int64_t change, Clamp& clamp) {
  for (std::size_t i = 0; i < 6; ++i)
    u[i] = clamp(u[i] + raw::round_shift(j[i] * change, 30));
}

inline void apply_row(const ProximalRow& row, std::int64_t change, BodyVector& a, BodyVector& b,
                      Clamp& clamp) {
  if (change == 0) return;
  add_to(a, row.a, change, clamp);
  add_to(b, row.b, change, clamp);
}

/// Adds to sums, which have room for the rows of an island.
inline void add_sum(const ProximalRow& row, std::int64_t change, BodyVector& a, BodyVector& b) {
  for (std::size_t i = 0; i < 6; ++i) {
    a[i] += raw::round_shift(row.a[i] * change, 30);
    b[i] += raw::round_shift(row.b[i] * change, 30);
  }
}

/// Returns whether nothing had to be clamped.
[[nodiscard]] inline bool clamp_all(std::span<BodyVector> sums) {
  Clamp clamp;
  for (BodyVector& sum : sums)
    for (std::int64_t& x : sum)
      x = clamp(x);
  return !clamp.hit();
}

}  // namespace lockstone::proximal
