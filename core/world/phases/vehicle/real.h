// Numbers of vehicles: 32 fraction bits of whatever unit, saturating.
#pragma once

#include <compare>
#include <cstdint>

#include <lockstone/assert.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/math/divide.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {

/// In SI units. Sums and products that do not fit become the nearest bound.
struct Real {
  std::int64_t raw = 0;

  [[nodiscard]] static constexpr Real ratio(std::int64_t a, std::int64_t b) {
    return {divide_raw_saturating(a, b, 32)};
  }
  template <class D, class R, int F>
  [[nodiscard]] static constexpr Real of(Fixed<D, R, F> x) {
    return {raw::scale_saturating(x.raw, 32 - F)};
  }
  template <class To>
  [[nodiscard]] constexpr To as() const {
    using R = typename To::Representation;
    return To::from_raw(raw::saturate<R>(raw::scale_saturating(raw, To::frac_bits - 32)));
  }

  friend constexpr auto operator<=>(const Real&, const Real&) = default;
  friend constexpr Real operator+(Real a, Real b) { return {raw::saturating_add(a.raw, b.raw)}; }
  friend constexpr Real operator-(Real a) { return {a.raw == INT64_MIN ? INT64_MAX : -a.raw}; }
  friend constexpr Real operator-(Real a, Real b) { return a + -b; }
  friend constexpr Real operator*(Real a, Real b) {
    return {saturate_to_int64(round_shift(multiply_wide(a.raw, b.raw), 32))};
  }
  /// b = 0 gives the bound of a's sign.
  friend constexpr Real operator/(Real a, Real b) {
    return {divide_raw_saturating(a.raw, b.raw, 32)};
  }
};

inline constexpr Real k_real_one{std::int64_t{1} << 32};

[[nodiscard]] constexpr Real clamp_real(Real x, Real low, Real high) {
  return x < low ? low : x > high ? high : x;
}
[[nodiscard]] constexpr Real abs_real(Real x) {
  return x < Real{} ? -x : x;
}
/// √(x² + y²), of up to 2^30.
[[nodiscard]] inline Real length_real(Real x, Real y) {
  constexpr Real k_most{std::int64_t{1} << 62};
  const Real a = clamp_real(x, -k_most, k_most), b = clamp_real(y, -k_most, k_most);
  return {static_cast<std::int64_t>(norm(a.raw, b.raw, 0))};
}

/// √x of x ≥ 0, rounded down.
[[nodiscard]] inline Real sqrt_real(Real x) {
  LKS_ASSERT(x >= Real{});
  const auto raw = static_cast<std::uint64_t>(x.raw);
  return {static_cast<std::int64_t>(isqrt128({raw >> 32, raw << 32}))};
}

struct Real3 {
  Real x, y, z;

  template <class T>
  [[nodiscard]] static constexpr Real3 of(const Vec3<T>& v) {
    return {Real::of(v.x), Real::of(v.y), Real::of(v.z)};
  }
  template <class To>
  [[nodiscard]] constexpr Vec3<To> as() const {
    return {x.as<To>(), y.as<To>(), z.as<To>()};
  }
  friend constexpr Real3 operator+(const Real3& a, const Real3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Real3 operator-(const Real3& a, const Real3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Real3 operator*(const Real3& a, Real b) { return {a.x * b, a.y * b, a.z * b}; }
};

[[nodiscard]] constexpr Real dot_real(const Real3& a, const Real3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Real3 cross_real(const Real3& a, const Real3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace lockstone
