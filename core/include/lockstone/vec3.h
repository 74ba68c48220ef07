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
};

/// A component-wise exact product with a scalar: both 32-bit, the result 64-bit.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto operator*(const Vec3<Fixed<D1, std::int32_t, F1>>& v,
                                       Fixed<D2, std::int32_t, F2> s) {
  using Product = decltype(v.x * s);
  return Vec3<Product>{v.x * s, v.y * s, v.z * s};
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
