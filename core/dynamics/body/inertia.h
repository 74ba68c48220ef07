// Normalised inertia tensors in world axes.
#pragma once

#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/state/body_record.h"

namespace lockstone {

/// The smallest normalised moment that is kept; smaller ones are raised to it.
inline constexpr Unit k_min_inertia = Unit::from_raw(1 << 18);  // 2^-12

/// The symmetric tensor M that turns spin into surface speed, w = M·spin. An entry's value is
/// raw · 2^(exponent − 30), and |raw| ≤ 2^30. Exponent 0 … 12.
struct InverseInertia {
  std::int32_t xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  int exponent = 0;
};

/// Whether M is a number times the unit matrix.
[[nodiscard]] constexpr bool turns_alike(const InverseInertia& m) {
  return m.xx == m.yy && m.yy == m.zz && (m.xy | m.xz | m.yz) == 0;
}

/// About locked axes a body does not turn. For one that does not rotate: zero. For a kinematic one,
/// whose spin is its surface speed: one.
[[nodiscard]] InverseInertia inverse_inertia(const BodyRecord& body, const Mat3& rotation);

/// w = M·spin, each component within one unit in the last place.
[[nodiscard]] Vec3<Velocity> surface_velocity(const InverseInertia& inertia,
                                              const Vec3<Velocity>& spin);

/// The inverse: spin of a body with surface speed w. Components are taken along the principal axes.
[[nodiscard]] Vec3<Velocity> spin_of(const BodyRecord& body, const Mat3& rotation,
                                     const Vec3<Velocity>& surface_velocity);

/// m·v and mᵀ·v for 64-bit vectors, each component rounded once per product.
[[nodiscard]] Vec3<Velocity> rotate_wide(const Mat3& m, const Vec3<Velocity>& v);
[[nodiscard]] Vec3<Velocity> rotate_inverse_wide(const Mat3& m, const Vec3<Velocity>& v);

}  // namespace lockstone
