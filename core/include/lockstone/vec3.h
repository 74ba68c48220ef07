// Vectors of typed fixed-point components.
#pragma once

#include <lockstone/fixed.h>

namespace lockstone {

template <class T>
struct Vec3 {
  T x{};
  T y{};
  T z{};

  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;

  [[nodiscard]] constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  [[nodiscard]] constexpr const T& operator[](int axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }

  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  constexpr Vec3 operator-() const { return {-x, -y, -z}; }
  constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }

  /// Times, and divided by, a whole number, component by component.
  friend constexpr Vec3 operator*(const Vec3& v, int factor) {
    return {v.x * factor, v.y * factor, v.z * factor};
  }
  friend constexpr Vec3 operator*(int factor, const Vec3& v) { return v * factor; }
  friend constexpr Vec3 operator/(const Vec3& v, int divisor) {
    return {v.x / divisor, v.y / divisor, v.z / divisor};
  }
  constexpr Vec3& operator*=(int factor) { return *this = *this * factor; }
  constexpr Vec3& operator/=(int divisor) { return *this = *this / divisor; }

  /// To a format that holds every value of this one: a Vec3<Length> is a Vec3<Position>.
  template <class Wider>
  requires(k_widens<T, Wider>) constexpr operator Vec3<Wider>()
      const {  // NOLINT(google-explicit-constructor)
    return {x, y, z};
  }
};

/// A component-wise exact product with a scalar: both 32-bit, the result 64-bit.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto operator*(const Vec3<Fixed<D1, std::int32_t, F1>>& v,
                                       Fixed<D2, std::int32_t, F2> s) {
  using Product = decltype(v.x * s);
  return Vec3<Product>{v.x * s, v.y * s, v.z * s};
}

/// A 64-bit vector times a plain number: the same quantity, each component rounded once; must fit.
template <class D, int F, int F2>
[[nodiscard]] constexpr Vec3<Fixed<D, std::int64_t, F>> operator*(
    const Vec3<Fixed<D, std::int64_t, F>>& v, Fixed<Dimension<0, 0, 0>, std::int32_t, F2> s) {
  return {v.x * s, v.y * s, v.z * s};
}

/// A vector of either width times a plain number, in its own format: rounded once, must fit.
template <class D, class Rep, int F, int F2>
[[nodiscard]] constexpr Vec3<Fixed<D, Rep, F>> scaled(
    const Vec3<Fixed<D, Rep, F>>& v, Fixed<Dimension<0, 0, 0>, std::int32_t, F2> s) {
  return {scaled(v.x, s), scaled(v.y, s), scaled(v.z, s)};
}

/// The exact dot product. The caller guarantees |a|·|b| < 2^63 raw.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto dot(const Vec3<Fixed<D1, std::int32_t, F1>>& a,
                                 const Vec3<Fixed<D2, std::int32_t, F2>>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The exact cross product. The caller guarantees |a|·|b| < 2^63 raw.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto cross(const Vec3<Fixed<D1, std::int32_t, F1>>& a,
                                   const Vec3<Fixed<D2, std::int32_t, F2>>& b) {
  using Product = decltype(a.x * b.x);
  return Vec3<Product>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class To, class From>
[[nodiscard]] constexpr Vec3<To> rounded(const Vec3<From>& v) {
  return {rounded<To>(v.x), rounded<To>(v.y), rounded<To>(v.z)};
}

template <class To, class From>
[[nodiscard]] constexpr Vec3<To> saturated(const Vec3<From>& v) {
  return {saturated<To>(v.x), saturated<To>(v.y), saturated<To>(v.z)};
}

}  // namespace lockstone
