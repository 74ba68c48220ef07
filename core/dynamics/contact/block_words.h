// Words of manifold blocks, lane by lane, and products of their operands.
#pragma once

#include <array>

#include <lockstone/assert.h>
#include <lockstone/fixed.h>

#include "core/dynamics/body/raw_vec3.h"
#include "core/kernels/contact/manifold_block.h"
#include "core/math/product_sum.h"

namespace lockstone {

[[nodiscard]] inline std::int64_t low_word(std::int64_t word) {
  return static_cast<std::int32_t>(word);
}
[[nodiscard]] inline std::int64_t high_word(std::int64_t word) {
  return word >> 32;
}
[[nodiscard]] inline RawVec3 low_words(const lanes::BlockWord (&words)[3], std::size_t lane) {
  return {low_word(words[0][lane]), low_word(words[1][lane]), low_word(words[2][lane])};
}
[[nodiscard]] inline RawVec3 high_words(const lanes::BlockWord (&words)[3], std::size_t lane) {
  return {high_word(words[0][lane]), high_word(words[1][lane]), high_word(words[2][lane])};
}
[[nodiscard]] inline RawVec3 normal_of(const lanes::ManifoldBlock& block, std::size_t lane) {
  return {low_word(block.axes[0][lane]), high_word(block.axes[0][lane]),
          low_word(block.axes[1][lane])};
}
[[nodiscard]] inline RawVec3 tangent_of(const lanes::ManifoldBlock& block, std::size_t lane) {
  return {high_word(block.axes[1][lane]), low_word(block.axes[2][lane]),
          high_word(block.axes[2][lane])};
}
[[nodiscard]] inline RawVec3 binormal_of(const lanes::ManifoldBlock& block, std::size_t lane) {
  return {low_word(block.axes[3][lane]), high_word(block.axes[3][lane]),
          low_word(block.axes[4][lane])};
}

/// Of each point; 0: no point.
[[nodiscard]] inline std::array<std::int64_t, lanes::k_block_points> masses_of(
    const lanes::ManifoldBlock& block, std::size_t lane) {
  return {low_word(block.mass_01[lane]), high_word(block.mass_01[lane]),
          low_word(block.mass_23[lane]), high_word(block.mass_23[lane])};
}

/// product_rounded(a, b, shift), 1 ≤ shift ≤ 120, sooner where a is small.
[[nodiscard]] inline std::int64_t scaled(std::int64_t a, std::int32_t b, int shift) {
  constexpr std::int64_t k_small = std::int64_t{1} << 31;
  if (a >= k_small || a <= -k_small || shift > 61) return product_rounded(a, b, shift);
  const std::int64_t product = a * b;
  return (product + (std::int64_t{1} << (shift - 1)) + (product >> 63)) >> shift;
}

/// r̄ × u + scale·turn, Q30.
[[nodiscard]] inline RawVec3 turned(const RawVec3& arm, const RawVec3& direction,
                                    std::int64_t scale, const RawVec3& turn) {
  RawVec3 result = cross(arm, direction);
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = raw::round_shift(result[i] + scale * turn[i], 30);
  return result;
}

/// A `ProductSum` whose every partial sum is known to stay below 2^62: the same results, sooner.
class SmallProductSum {
 public:
  constexpr void add(std::int64_t a, std::int64_t b) { add_product(a * b); }
  constexpr void subtract(std::int64_t a, std::int64_t b) { add_product(-(a * b)); }
  [[nodiscard]] constexpr std::int64_t rounded(int shift) const {
    return raw::round_shift(sum_, shift);
  }

 private:
  constexpr void add_product(std::int64_t product) {
    sum_ += product;
    LKS_ASSERT(magnitude(sum_) >> 62 == 0);
  }

  std::int64_t sum_ = 0;
};

/// a·x + b·y, in 30 bits less.
template <class Sum = ProductSum>
[[nodiscard]] RawVec3 mixed(const RawVec3& a, std::int64_t x, const RawVec3& b, std::int64_t y) {
  RawVec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    Sum sum;
    sum.add(a[i], x);
    sum.add(b[i], y);
    result[i] = sum.rounded(30);
  }
  return result;
}

/// arm × force + torque·turn, in 30 bits less.
template <class Sum = ProductSum>
[[nodiscard]] RawVec3 moment_of(const RawVec3& arm, const RawVec3& force, const RawVec3& torque,
                                std::int64_t turn) {
  RawVec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    Sum sum;
    sum.add(arm[j], force[k]);
    sum.subtract(arm[k], force[j]);
    sum.add(torque[i], turn);
    result[i] = sum.rounded(30);
  }
  return result;
}

/// u·v.
[[nodiscard]] inline ProductSum dot_sum(const RawVec3& u, const RawVec3& v) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i)
    sum.add(u[i], v[i]);
  return sum;
}

/// u·v + angular·response, Q30.
[[nodiscard]] inline std::int64_t coupled(const RawVec3& linear_x, const RawVec3& linear_y,
                                          const RawVec3& angular_x, const RawVec3& response_y) {
  ProductSum sum = dot_sum(linear_x, linear_y);
  for (std::size_t i = 0; i < 3; ++i)
    sum.add(angular_x[i], response_y[i]);
  return sum.rounded(30);
}

}  // namespace lockstone
