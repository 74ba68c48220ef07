// Words of manifold blocks, lane by lane, and products of what they hold.
#pragma once

#include <lockstone/fixed.h>

#include "core/dynamics/raw_vec3.h"
#include "core/math/product_sum.h"
#include "core/math/wide/manifold_block.h"

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

/// r̄ × u + scale·turn, Q30.
[[nodiscard]] inline RawVec3 turned(const RawVec3& arm, const RawVec3& direction,
                                    std::int64_t scale, const RawVec3& turn) {
  RawVec3 result = cross(arm, direction);
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = raw::round_shift(result[i] + scale * turn[i], 30);
  return result;
}

/// a·x + b·y, in 30 bits less.
[[nodiscard]] inline RawVec3 mixed(const RawVec3& a, std::int64_t x, const RawVec3& b,
                                   std::int64_t y) {
  RawVec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    ProductSum sum;
    sum.add(a[i], x);
    sum.add(b[i], y);
    result[i] = sum.rounded(30);
  }
  return result;
}

/// u·v + angular·response, Q30.
[[nodiscard]] inline std::int64_t coupled(const RawVec3& linear_x, const RawVec3& linear_y,
                                          const RawVec3& angular_x, const RawVec3& response_y,
                                          bool opposite) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(linear_x[i], linear_y[i]);
    sum.add(angular_x[i], response_y[i]);
  }
  const std::int64_t rounded = sum.rounded(30);
  return opposite ? -rounded : rounded;
}

}  // namespace lockstone
