// Lengths, directions and products of vectors of any format, for the game's own rules.
#pragma once

#include <cstdint>
#include <type_traits>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

namespace vector_detail {

using Words = Vec3<Position>;  // raw integers of any unit

template <class D, class Rep, int F>
[[nodiscard]] constexpr Words words(const Vec3<Fixed<D, Rep, F>>& v) {
  return {Position::from_raw(v.x.raw), Position::from_raw(v.y.raw), Position::from_raw(v.z.raw)};
}

/// |v| to nearest, clamped to int64; v / |v|; a.x · b.x + … and a · b − c · d, each
/// product · 2^-shift rounded, all clamped to int64.
[[nodiscard]] std::int64_t length(const Words& v);
[[nodiscard]] Vec3<Unit> direction(const Words& v);
[[nodiscard]] std::int64_t dot(const Words& a, const Words& b, int shift);
[[nodiscard]] std::int64_t minor_of(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d,
                                    int shift);

/// Products with a 64-bit vector: the other's format when that has 32 bits, so that a place along a
/// direction stays a place; 16 fraction bits of two 64-bit ones, for ±2^47 square units.
template <class A, class B>
struct Product;
template <class D1, class D2, int F1, int F2>
struct Product<Fixed<D1, std::int64_t, F1>, Fixed<D2, std::int32_t, F2>> {
  using Type = Fixed<DimensionProduct<D1, D2>, std::int64_t, F1>;
  static constexpr int shift = F2;
};
template <class D1, class D2, int F1, int F2>
struct Product<Fixed<D1, std::int32_t, F1>, Fixed<D2, std::int64_t, F2>> {
  using Type = Fixed<DimensionProduct<D1, D2>, std::int64_t, F2>;
  static constexpr int shift = F1;
};
template <class D1, class D2, int F1, int F2>
struct Product<Fixed<D1, std::int64_t, F1>, Fixed<D2, std::int64_t, F2>> {
  using Type = Fixed<DimensionProduct<D1, D2>, std::int64_t, 16>;
  static constexpr int shift = F1 + F2 - 16;
};

}  // namespace vector_detail

/// |v| to nearest; a length beyond the format becomes its maximum.
template <class D, class Rep, int F>
[[nodiscard]] Fixed<D, Rep, F> length(const Vec3<Fixed<D, Rep, F>>& v) {
  return Fixed<D, Rep, F>::from_raw(
      raw::saturate<Rep>(vector_detail::length(vector_detail::words(v))));
}

/// |a − b|; the difference must fit.
template <class T>
[[nodiscard]] T distance(const Vec3<T>& a, const Vec3<T>& b) {
  return length(a - b);
}

/// The unit vector along v, each component in error by less than 0.51 · 2^-30; zero of zero.
template <class D, class Rep, int F>
[[nodiscard]] Vec3<Unit> normalized(const Vec3<Fixed<D, Rep, F>>& v) {
  return vector_detail::direction(vector_detail::words(v));
}

/// So much along a direction: normalized(v) * Force(400_N). Each component is rounded once; must
/// fit.
template <class D, int F, int F2>
[[nodiscard]] constexpr Vec3<Fixed<D, std::int64_t, F>> operator*(
    const Vec3<Fixed<Scalar, std::int32_t, F2>>& direction, Fixed<D, std::int64_t, F> size) {
  return {size * direction.x, size * direction.y, size * direction.z};
}

/// The dot product where a vector has 64 bits: each product rounded, clamped to its format, which
/// is that of the 64-bit vector, or has 16 fraction bits where both are (15 µ of a square unit,
/// ±2^47).
template <class D1, class R1, int F1, class D2, class R2, int F2>
requires(sizeof(R1) + sizeof(R2) > 8)
    [[nodiscard]] auto dot(const Vec3<Fixed<D1, R1, F1>>& a, const Vec3<Fixed<D2, R2, F2>>& b) {
  using P = vector_detail::Product<Fixed<D1, R1, F1>, Fixed<D2, R2, F2>>;
  return P::Type::from_raw(
      vector_detail::dot(vector_detail::words(a), vector_detail::words(b), P::shift));
}

/// The cross product where a vector has 64 bits; rounding and format as for `dot`.
template <class D1, class R1, int F1, class D2, class R2, int F2>
requires(sizeof(R1) + sizeof(R2) > 8)
    [[nodiscard]] auto cross(const Vec3<Fixed<D1, R1, F1>>& a, const Vec3<Fixed<D2, R2, F2>>& b) {
  using P = vector_detail::Product<Fixed<D1, R1, F1>, Fixed<D2, R2, F2>>;
  using T = typename P::Type;
  const auto minor_of = [&](int j, int k) {
    return T::from_raw(vector_detail::minor_of(a[j].raw, b[k].raw, a[k].raw, b[j].raw, P::shift));
  };
  return Vec3<T>{minor_of(1, 2), minor_of(2, 0), minor_of(0, 1)};
}

/// a + (b − a) · t, of quantities and of vectors. t = 0 gives a, t = 1 gives b, exactly.
template <class T, class Factor>
[[nodiscard]] constexpr T lerp(const T& a, const T& b, Factor t) {
  if constexpr (requires { scaled(b - a, t); })
    return a + scaled(b - a, t);
  else
    return a + (b - a) * t;  // a literal
}

/// Component by component.
template <class T>
[[nodiscard]] constexpr Vec3<T> abs(const Vec3<T>& v) {
  return {abs(v.x), abs(v.y), abs(v.z)};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
template <class T>
[[nodiscard]] constexpr Vec3<T> clamp(const Vec3<T>& v, const Vec3<T>& low, const Vec3<T>& high) {
  return {clamp(v.x, low.x, high.x), clamp(v.y, low.y, high.y), clamp(v.z, low.z, high.z)};
}

/// v, shortened to the length `most` where it is longer, with a relative error below 2^-29 and half
/// a last place of each component. most ≥ 0.
template <class T>
[[nodiscard]] Vec3<T> clamp_length(const Vec3<T>& v, std::type_identity_t<T> most) {
  LKS_ASSERT(most >= T{});
  if (length(v) <= most) return v;
  const Vec3<Unit> direction = normalized(v);
  return {scaled(most, direction.x), scaled(most, direction.y), scaled(most, direction.z)};
}

/// `from`, moved towards `to` by at most `most`; `to` itself once it is that near. The difference
/// must fit; most ≥ 0.
template <class D, class Rep, int F>
[[nodiscard]] constexpr Fixed<D, Rep, F> move_toward(Fixed<D, Rep, F> from,
                                                     std::type_identity_t<Fixed<D, Rep, F>> to,
                                                     std::type_identity_t<Fixed<D, Rep, F>> most) {
  LKS_ASSERT(most >= (Fixed<D, Rep, F>{}));
  return from + clamp(to - from, -most, most);
}

/// The same along the straight line between two points, or of velocities; each step errs as
/// `clamp_length` does.
template <class T>
[[nodiscard]] Vec3<T> move_toward(const Vec3<T>& from, const std::type_identity_t<Vec3<T>>& to,
                                  std::type_identity_t<T> most) {
  return from + clamp_length(to - from, most);
}

}  // namespace lockstone
