// Vectors of raw 64-bit lanes with products of 128 bits, and of 128-bit lanes.
#pragma once

#include <algorithm>

#include "core/geometry/numeric/q50.h"
#include "core/math/int128.h"

namespace lockstone::geometry {

[[nodiscard]] constexpr bool is_negative(std::int64_t x) {
  return x < 0;
}
[[nodiscard]] constexpr bool is_negative(Int128 x) {
  return x.negative();
}
[[nodiscard]] constexpr bool is_positive(Int128 x) {
  return !x.negative() && (x.high != 0 || x.low != 0);
}
[[nodiscard]] constexpr bool is_zero(Int128 x) {
  return x.high == 0 && x.low == 0;
}

/// a · b for |a|·|b| < 2^63.
[[nodiscard]] constexpr std::int64_t narrow_dot(const RawVec& a, const RawVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// a × b for |a|·|b| < 2^62.
[[nodiscard]] constexpr RawVec narrow_cross(const RawVec& a, const RawVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// a · b, exact for |a|·|b| < 2^127.
[[nodiscard]] constexpr Int128 wide_dot(const RawVec& a, const RawVec& b) {
  return multiply_wide(a.x, b.x) + multiply_wide(a.y, b.y) + multiply_wide(a.z, b.z);
}

struct WideVec {
  Int128 x;
  Int128 y;
  Int128 z;
};

/// a × b, exact for |a|·|b| < 2^127.
[[nodiscard]] constexpr WideVec wide_cross(const RawVec& a, const RawVec& b) {
  return {multiply_wide(a.y, b.z) - multiply_wide(a.z, b.y),
          multiply_wide(a.z, b.x) - multiply_wide(a.x, b.z),
          multiply_wide(a.x, b.y) - multiply_wide(a.y, b.x)};
}

/// `v` scaled by a power of two, down only, so that every |component| is below 2^bits; rounded
/// towards zero.
[[nodiscard]] constexpr RawVec truncated(const WideVec& v, int bits) {
  const UInt128 x = magnitude(v.x);
  const UInt128 y = magnitude(v.y);
  const UInt128 z = magnitude(v.z);
  const UInt128 all{x.high | y.high | z.high, x.low | y.low | z.low};
  const int shift = std::max(0, 128 - bits - countl_zero(all));
  const auto lane = [shift](UInt128 size, bool negative) {
    const auto value = static_cast<std::int64_t>((size >> shift).low);
    return negative ? -value : value;
  };
  return {lane(x, v.x.negative()), lane(y, v.y.negative()), lane(z, v.z.negative())};
}

[[nodiscard]] constexpr RawVec truncated(const RawVec& v, int bits) {
  const auto all = magnitude(v.x) | magnitude(v.y) | magnitude(v.z);
  const int shift = std::max(0, 64 - bits - std::countl_zero(all));
  const auto lane = [shift](std::int64_t x) {
    const auto size = static_cast<std::int64_t>(magnitude(x) >> shift);
    return x < 0 ? -size : size;
  };
  return {lane(v.x), lane(v.y), lane(v.z)};
}

}  // namespace lockstone::geometry
