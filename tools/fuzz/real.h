// Fixed-point geometry in double, for references: sums of exact coordinates below 2^12 m err by
// less than 1e-11 m.
#pragma once

#include <algorithm>
#include <cmath>

#include <lockstone/quat.h>
#include <lockstone/testing/floating.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::fuzz {

struct Real3 {
  double x = 0;
  double y = 0;
  double z = 0;

  friend constexpr Real3 operator+(const Real3& a, const Real3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Real3 operator-(const Real3& a, const Real3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Real3 operator*(const Real3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
  constexpr Real3 operator-() const { return {-x, -y, -z}; }
};

[[nodiscard]] constexpr double dot(const Real3& a, const Real3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Real3 cross(const Real3& a, const Real3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double norm(const Real3& a) {
  return std::sqrt(dot(a, a));
}
/// Of norm 1; zero stays.
[[nodiscard]] inline Real3 direction_of(const Real3& a) {
  const double length = norm(a);
  return length > 0 ? a * (1 / length) : a;
}

template <class D, class R, int F>
[[nodiscard]] constexpr double real(Fixed<D, R, F> x) {
  return testing::to_double(x);
}
template <class T>
[[nodiscard]] constexpr Real3 real(const Vec3<T>& v) {
  return {real(v.x), real(v.y), real(v.z)};
}
/// m · v with the matrix as it stands, rounded.
[[nodiscard]] constexpr Real3 turn(const Mat3& m, const Real3& v) {
  return real(m.x) * v.x + real(m.y) * v.y + real(m.z) * v.z;
}

[[nodiscard]] inline Length to_length(double x) {
  return Length::from_raw(static_cast<std::int32_t>(std::lround(std::ldexp(x, Length::frac_bits))));
}
[[nodiscard]] inline Vec3<Length> to_length(const Real3& v) {
  return {to_length(v.x), to_length(v.y), to_length(v.z)};
}
[[nodiscard]] inline Unit to_unit(double x) {
  return Unit::from_raw(static_cast<std::int32_t>(std::lround(std::ldexp(x, Unit::frac_bits))));
}
[[nodiscard]] inline Vec3<Unit> to_unit(const Real3& v) {
  return {to_unit(v.x), to_unit(v.y), to_unit(v.z)};
}
/// Of any norm but zero.
[[nodiscard]] inline Quat to_quat(const Real3& v, double w) {
  const double length = std::sqrt(dot(v, v) + w * w);
  if (length < 1e-9) return {};
  return {to_unit(v.x / length), to_unit(v.y / length), to_unit(v.z / length), to_unit(w / length)};
}

/// Distance of p from the segment ab, which may be a point.
[[nodiscard]] inline double point_to_segment(const Real3& p, const Real3& a, const Real3& b) {
  const Real3 ab = b - a;
  const double square = dot(ab, ab);
  if (square == 0) return norm(p - a);
  return norm(p - a - ab * std::clamp(dot(p - a, ab) / square, 0.0, 1.0));
}

/// Distance of p from the triangle abc, which may be a segment or a point.
[[nodiscard]] inline double point_to_triangle(const Real3& p, const Real3& a, const Real3& b,
                                              const Real3& c) {
  const double rim =
      std::min({point_to_segment(p, a, b), point_to_segment(p, b, c), point_to_segment(p, c, a)});
  const Real3 n = cross(b - a, c - a);
  const double square = dot(n, n);
  const bool above = square > 0 && dot(cross(b - p, c - p), n) >= 0 &&
                     dot(cross(c - p, a - p), n) >= 0 && dot(cross(a - p, b - p), n) >= 0;
  return above ? std::min(rim, std::abs(dot(p - a, n)) / std::sqrt(square)) : rim;
}

}  // namespace lockstone::fuzz
