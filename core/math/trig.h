// Angles and rotations.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

struct SinCos {
  Unit sin;
  Unit cos;
};

/// Radians in the format of a master velocity times a second: a rotation vector's component.
using RotationComponent = Fixed<Scalar, std::int64_t, 32>;
using RotationVector = Vec3<RotationComponent>;

/// Sine and cosine, each within 1 · 2^-30 (measured over all inputs: 0.77). sin(−x) = −sin(x) and
/// cos(−x) = cos(x), exactly.
[[nodiscard]] SinCos sin_cos(Angle x);

/// ⌊tan x · 2^result_bits⌉ within ±(2^31 − 1), the nearest bound beyond: next to ±π/2.
[[nodiscard]] std::int32_t tan_raw_saturating(Angle x, int result_bits);

/// Tangent, within 0.5001 last places; ±To::max() where it does not fit.
/// tan(−x) = −tan(x) exactly.
template <class To = Number>
[[nodiscard]] To tan_saturating(Angle x) {
  static_assert(sizeof(typename To::Representation) == 4);
  return To::from_raw(tan_raw_saturating(x, To::frac_bits));
}

/// As `tan_saturating`; |tan x| must be below To::max().
template <class To = Number>
[[nodiscard]] To tan(Angle x) {
  const To tangent = tan_saturating<To>(x);
  LKS_ASSERT(tangent.raw != To::max().raw && tangent.raw != -To::max().raw);
  return tangent;
}

/// The angle of the vector (x, y) in (−π, π], within 1 · 2^-27 (measured: 0.501), for raws of any
/// scale. (0, 0) gives 0. Odd in y exactly, but for (x < 0, y = 0), which gives +π.
[[nodiscard]] Angle atan2_raw(std::int64_t y, std::int64_t x);

template <class D, class Rep, int F>
[[nodiscard]] Angle atan2(Fixed<D, Rep, F> y, Fixed<D, Rep, F> x) {
  return atan2_raw(y.raw, x.raw);
}

/// Arc sine in [−π/2, π/2] and arc cosine in [0, π], within 1 · 2^-27 (measured: 0.57); beyond
/// ±1 as at ±1.
[[nodiscard]] Angle asin(Unit x);
[[nodiscard]] Angle acos(Unit x);

/// The same with 31 fraction bits.
struct FineSinCos {
  std::int64_t sin = 0;
  std::int64_t cos = 0;
};

/// Of half an angle, each within 2^-31. The sine is odd, exactly.
[[nodiscard]] FineSinCos half_sin_cos(RotationComponent angle);

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
