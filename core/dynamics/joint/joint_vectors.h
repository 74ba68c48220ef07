// Vectors in the formats of a joint's rows.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/assert.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/body/raw_vec3.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"

namespace lockstone {

[[nodiscard]] inline RawVec3 raw_of(const Vec3<Unit>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

// x · 2^-shift for either sign of `shift`, within ±2^44.
[[nodiscard]] inline std::int64_t shifted(std::int64_t x, int shift) {
  LKS_ASSERT(shift >= -44);
  constexpr std::int64_t k_bound = std::int64_t{1} << 44;
  if (shift >= 0) return std::clamp(raw::round_shift(x, std::min(shift, 62)), -k_bound, k_bound);
  return std::clamp(x, -(k_bound >> -shift), k_bound >> -shift) * (std::int64_t{1} << -shift);
}

// (arm / 2^exponent) × n, Q30, from an arm in Q32.
[[nodiscard]] inline RawVec3 lever(const Vec3<Position>& arm, const RawVec3& n, int exponent) {
  LKS_ASSERT(exponent > -32 && exponent < 64);
  const auto part = [&](Position p, std::int64_t y, Position q, std::int64_t z) {
    ProductSum sum;
    sum.add(p.raw, y);
    sum.subtract(q.raw, z);
    return sum.rounded(32 + exponent);
  };
  return {part(arm.y, n[2], arm.z, n[1]), part(arm.z, n[0], arm.x, n[2]),
          part(arm.x, n[1], arm.y, n[0])};
}

// The dot product of unit vectors, Q30.
[[nodiscard]] inline std::int64_t cosine(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  return raw::round_shift(dot(a, b).raw, 30);
}

[[nodiscard]] inline RawVec3 cross_raw(const RawVec3& a, const RawVec3& b) {
  const auto part = [](std::int64_t p, std::int64_t y, std::int64_t q, std::int64_t z) {
    ProductSum sum;
    sum.add(p, y);
    sum.subtract(q, z);
    return sum.rounded(30);
  };
  return {part(a[1], b[2], a[2], b[1]), part(a[2], b[0], a[0], b[2]), part(a[0], b[1], a[1], b[0])};
}

[[nodiscard]] inline RawVec3 divided(const RawVec3& v, std::int64_t divisor_q30) {
  LKS_ASSERT(divisor_q30 > 0);
  const auto part = [&](std::int64_t x) {
    return raw::round_divide(std::clamp(x, -4 * k_one, 4 * k_one) * k_one, divisor_q30);
  };
  return {part(v[0]), part(v[1]), part(v[2])};
}

// An arm in Q32, as lever(arm, n, exponent) has it for axes of the world.
[[nodiscard]] inline RawVec3 scaled_arm(const Vec3<Position>& arm, int exponent) {
  const auto part = [&](Position p) { return raw::scale_binary(p.raw, -2 - exponent); };
  return {part(arm.x), part(arm.y), part(arm.z)};
}

[[nodiscard]] inline std::int64_t along(const Vec3<Position>& v, const RawVec3& n) {
  ProductSum sum;
  for (int i = 0; i < 3; ++i)
    sum.add(v[i].raw, n[static_cast<std::size_t>(i)]);
  return sum.rounded(30);
}

}  // namespace lockstone
