#include "core/dynamics/body/inertia.h"

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "core/dynamics/body/principal_inverse.h"

namespace lockstone {
namespace {

// 1/I for a principal moment, Q30: 2^30 … 2^42.
std::int64_t reciprocal(Unit moment) {
  LKS_ASSERT(moment > Unit{});
  return raw::round_divide(std::int64_t{1} << 60, moment.raw);
}

std::int32_t product_q30(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(raw::round_shift(std::int64_t{a} * b, 30));
}

Velocity times(Velocity v, std::int32_t factor, int shift) {
  return Velocity::from_raw(raw::multiply_shift(v.raw, factor, shift));
}

InverseInertia isotropic(std::int64_t value_q30) {
  LKS_ASSERT(value_q30 > 0);
  InverseInertia m;
  while ((value_q30 >> m.exponent) > (std::int64_t{1} << 30))
    ++m.exponent;
  m.xx = m.yy = m.zz = static_cast<std::int32_t>(raw::round_shift(value_q30, m.exponent));
  return m;
}

// With axis k locked, the response of the others is the inverse of the inertia without its row and
// column k. In terms of M: M − m mᵀ/m_kk, with m its row k.
InverseInertia without_axis(const InverseInertia& m, int k) {
  const std::int64_t entry[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
  const std::int64_t own = std::max<std::int64_t>(entry[k][k], 1);
  LKS_ASSERT(k >= 0 && k < 3);
  const auto left = [&](int i, int j) {
    if (i == k || j == k) return 0;
    const std::int64_t taken = raw::round_divide(entry[i][k] * entry[j][k], own);
    return static_cast<std::int32_t>(entry[i][j] - taken);
  };
  return {left(0, 0), left(1, 1), left(2, 2), left(0, 1), left(0, 2), left(1, 2), m.exponent};
}

InverseInertia locked(const BodyRecord& body, InverseInertia m) {
  if ((body.locks & k_lock_turning) == 0) return m;
  for (int axis = 0; axis < 3; ++axis)
    if (body.is_turn_locked(axis)) m = without_axis(m, axis);
  return m;
}

}  // namespace

InverseInertia inverse_inertia(const BodyRecord& body, const Mat3& rotation) {
  if (!body.rotates() || body.is_static()) return {};
  if (!body.is_dynamic()) return isotropic(std::int64_t{1} << 30);
  if (body.has_spherical_inertia()) return locked(body, isotropic(reciprocal(body.inertia.x)));
  return locked(body, inverse_inertia(principal_inverse(body.inertia), rotation));
}

PrincipalInverse principal_inverse(const Vec3<Unit>& moments) {
  const std::array<std::int64_t, 3> inverse = {reciprocal(moments.x), reciprocal(moments.y),
                                               reciprocal(moments.z)};
  PrincipalInverse result;
  const std::int64_t largest = std::max({inverse[0], inverse[1], inverse[2]});
  while ((largest >> result.exponent) > (std::int64_t{1} << 30))
    ++result.exponent;
  for (std::size_t k = 0; k < 3; ++k) {
    result.raw[k] = static_cast<std::int32_t>(raw::round_shift(inverse[k], result.exponent));
  }
  LKS_ASSERT(result.raw[0] >= 0 && result.raw[1] >= 0 && result.raw[2] >= 0);
  return result;
}

// Column k of R scaled by 1/I_k, times column k again, summed over k.
InverseInertia inverse_inertia(const PrincipalInverse& inverse, const Mat3& rotation) {
  std::int64_t sum[6] = {};
  for (int k = 0; k < 3; ++k) {
    const Vec3<Unit>& axis = rotation.column(k);
    const std::int32_t scale = inverse.raw[static_cast<std::size_t>(k)];
    const std::int32_t x = product_q30(axis.x.raw, scale);
    const std::int32_t y = product_q30(axis.y.raw, scale);
    const std::int32_t z = product_q30(axis.z.raw, scale);
    sum[0] += std::int64_t{x} * axis.x.raw;
    sum[1] += std::int64_t{y} * axis.y.raw;
    sum[2] += std::int64_t{z} * axis.z.raw;
    sum[3] += std::int64_t{x} * axis.y.raw;
    sum[4] += std::int64_t{x} * axis.z.raw;
    sum[5] += std::int64_t{y} * axis.z.raw;
  }
  const auto entry = [](std::int64_t q60) {
    return static_cast<std::int32_t>(raw::round_shift(q60, 30));
  };
  InverseInertia m;
  m.exponent = inverse.exponent;
  m.xx = entry(sum[0]), m.yy = entry(sum[1]), m.zz = entry(sum[2]);
  m.xy = entry(sum[3]), m.xz = entry(sum[4]), m.yz = entry(sum[5]);
  LKS_ASSERT(m.xx >= 0 && m.yy >= 0 && m.zz >= 0 && m.exponent >= 0);
  return m;
}

Vec3<Velocity> surface_velocity(const InverseInertia& m, const Vec3<Velocity>& spin) {
  const int shift = 30 - m.exponent;
  LKS_ASSERT(shift >= 0 && shift <= 30);
  if ((m.xy | m.xz | m.yz) == 0)
    return {times(spin.x, m.xx, shift), times(spin.y, m.yy, shift), times(spin.z, m.zz, shift)};
  const auto row = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    return times(spin.x, a, shift) + times(spin.y, b, shift) + times(spin.z, c, shift);
  };
  return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
}

Vec3<Velocity> rotate_wide(const Mat3& m, const Vec3<Velocity>& v) {
  const auto row = [&](Unit a, Unit b, Unit c) {
    return times(v.x, a.raw, 30) + times(v.y, b.raw, 30) + times(v.z, c.raw, 30);
  };
  return {row(m.x.x, m.y.x, m.z.x), row(m.x.y, m.y.y, m.z.y), row(m.x.z, m.y.z, m.z.z)};
}

Vec3<Velocity> rotate_inverse_wide(const Mat3& m, const Vec3<Velocity>& v) {
  const auto row = [&](const Vec3<Unit>& axis) {
    return times(v.x, axis.x.raw, 30) + times(v.y, axis.y.raw, 30) + times(v.z, axis.z.raw, 30);
  };
  return {row(m.x), row(m.y), row(m.z)};
}

Vec3<Velocity> spin_of(const BodyRecord& body, const Mat3& rotation,
                       const Vec3<Velocity>& surface_velocity) {
  if (!body.rotates() || body.is_static()) return {};
  if (!body.is_dynamic()) return surface_velocity;
  LKS_ASSERT(body.inertia.x > Unit{} && body.inertia.y > Unit{} && body.inertia.z > Unit{});
  const auto unlocked = [&](Vec3<Velocity> v) {
    for (int i = 0; i < 3; ++i)
      if (body.is_turn_locked(i)) v[i] = {};
    return v;
  };
  const Vec3<Velocity> local = rotate_inverse_wide(rotation, unlocked(surface_velocity));
  const Vec3<Velocity> spin = {times(local.x, body.inertia.x.raw, 30),
                               times(local.y, body.inertia.y.raw, 30),
                               times(local.z, body.inertia.z.raw, 30)};
  return unlocked(rotate_wide(rotation, spin));
}

}  // namespace lockstone
