// Sines, tangents and their inverses. How they are computed, bit by bit:
// docs/explanation/numerics.md.
#pragma once

#include <cstdint>

#include <lockstone/units.h>

namespace lockstone {

struct SinCos {
  Unit sin;
  Unit cos;
};

/// Sine and cosine, each within 1 · 2^-30 (measured over all inputs: 0.77). sin(−x) = −sin(x) and
/// cos(−x) = cos(x), exactly.
[[nodiscard]] SinCos sin_cos(Angle x);

/// One of the two; where both are needed, `sin_cos` costs the same.
[[nodiscard]] inline Unit sin(Angle x) {
  return sin_cos(x).sin;
}
[[nodiscard]] inline Unit cos(Angle x) {
  return sin_cos(x).cos;
}

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

/// The same for two quantities of one format.
template <class D, class Rep, int F>
[[nodiscard]] Angle atan2(Fixed<D, Rep, F> y, Fixed<D, Rep, F> x) {
  return atan2_raw(y.raw, x.raw);
}

/// Arc sine in [−π/2, π/2] and arc cosine in [0, π], within 1 · 2^-27 (measured: 0.57); beyond
/// ±1 as at ±1.
[[nodiscard]] Angle asin(Unit x);
[[nodiscard]] Angle acos(Unit x);

}  // namespace lockstone
