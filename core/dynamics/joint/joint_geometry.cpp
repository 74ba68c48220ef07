#include "core/dynamics/joint/joint_geometry.h"

#include "core/math/trig.h"

namespace lockstone {

// With the relative rotation R = aᵀ·b and its quaternion (x, y, z, w):
// R₃₂ − R₂₃ = 4xw and R₂₂ + R₃₃ = 2(w² − x²), so that their quotient is the tangent of 2·atan(x/w).
Angle twist_of(const Mat3& a, const Mat3& b) {
  return atan2_raw(dot(a.z, b.y).raw / 2 - dot(a.y, b.z).raw / 2,
                   dot(a.y, b.y).raw / 2 + dot(a.z, b.z).raw / 2);
}

Vec3<Angle> swing_twist(const Mat3& a, const Mat3& b) {
  const std::int64_t along = dot(a.x, b.x).raw;
  return {twist_of(a, b), atan2_raw(-dot(a.z, b.x).raw, along),
          atan2_raw(dot(a.y, b.x).raw, along)};
}

}  // namespace lockstone
