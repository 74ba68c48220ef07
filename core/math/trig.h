// Rotations. Sines, tangents and their inverses are in <lockstone/trigonometry.h>.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/trigonometry.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Radians in the format of a master velocity times a second: a rotation vector's component.
using RotationComponent = Fixed<Scalar, std::int64_t, 32>;
using RotationVector = Vec3<RotationComponent>;

/// Sine and cosine with 31 fraction bits.
struct FineSinCos {
  std::int64_t sin = 0;
  std::int64_t cos = 0;
};

/// Of half an angle, each within 2^-31. The sine is odd, exactly.
[[nodiscard]] FineSinCos half_sin_cos(RotationComponent angle);

/// The angle of (x, y) in [0, π], within 2^-32; 0 for (0, 0).
[[nodiscard]] RotationComponent fine_arc(std::uint64_t y, std::int64_t x);

/// exp(θ/2): the rotation by |θ| radians about θ, for every input; components within 2^-29
/// (measured: 0.70 · 2^-30 up to |θ| = ½, 1.31 · 2^-30 beyond). θ → −θ flips the vector part
/// exactly; mirroring and permuting axes is exact too. Up to |θ| = ½ a short polynomial, beyond it
/// a reduction modulo 2π.
[[nodiscard]] Quat rotation_from_vector(const RotationVector& theta);

/// The orientation q after the world-frame rotation by θ: exp(θ/2) · q / |q|, with the rotation
/// taken two bits finer than a Quat and one rounding per component; the norm stays within 2^-30.
/// θ = 0 returns q itself, bit for bit, so that a body at rest does not creep.
[[nodiscard]] Quat integrate(const Quat& q, const RotationVector& theta);

/// A quaternion with 31 fraction bits, its length within 2^-21 of 1: a product of rotations, each
/// rounded, whose end `integrate` makes a unit again.
struct FineQuat {
  std::array<std::int64_t, 3> v{};
  std::int64_t w = std::int64_t{1} << 31;

  friend bool operator==(const FineQuat&, const FineQuat&) = default;
};

/// The same after a turn in the body's own axes: exp(θ/2) · q · turn / |q · turn|.
/// The norm stays within 1.5 · 2^-30.
[[nodiscard]] Quat integrate(const Quat& q, const RotationVector& theta, const FineQuat& turn);

}  // namespace lockstone
