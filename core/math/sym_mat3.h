// Symmetric 3×3 matrices: inertia and other tensors.
//
// A 3×3 matrix of 32-bit integers has a determinant below 2^96, so its inverse is an exact quotient
// of whole numbers: every entry here is rounded once from it, however ill-conditioned the matrix
// is. Scaling each axis by a power of two (equilibration) keeps small and large axes equally
// precise.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/math/divide.h"
#include "core/math/int128.h"

namespace lockstone {

template <class T>
struct SymMat3 {
  T xx{}, yy{}, zz{};
  T xy{}, xz{}, yz{};

  friend constexpr bool operator==(const SymMat3&, const SymMat3&) = default;

  friend constexpr SymMat3 operator+(const SymMat3& a, const SymMat3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend constexpr SymMat3 operator-(const SymMat3& a, const SymMat3& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
  }
};

using RawSymMat3 = SymMat3<std::int32_t>;

template <class D, int F>
[[nodiscard]] constexpr RawSymMat3 raw_of(const SymMat3<Fixed<D, std::int32_t, F>>& s) {
  return {s.xx.raw, s.yy.raw, s.zz.raw, s.xy.raw, s.xz.raw, s.yz.raw};
}

/// The exact product with a vector. The caller guarantees that each of its sums is below 2^63 raw.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto operator*(const SymMat3<Fixed<D1, std::int32_t, F1>>& s,
                                       const Vec3<Fixed<D2, std::int32_t, F2>>& v) {
  using Product = decltype(s.xx * v.x);
  return Vec3<Product>{s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
                       s.xz * v.x + s.yz * v.y + s.zz * v.z};
}

/// r·s·rᵀ of raws, each entry rounded once. r is a rotation and the result must fit, as it does
/// when every |entry| of s is at most 2^29.
[[nodiscard]] RawSymMat3 rotate_raw(const Mat3& r, const RawSymMat3& s);

/// r·s·rᵀ: the tensor s of body axes in world axes. Each entry is rounded once; |entry| ≤ 2^29 raw.
template <class D, int F>
[[nodiscard]] SymMat3<Fixed<D, std::int32_t, F>> rotate(
    const Mat3& r, const SymMat3<Fixed<D, std::int32_t, F>>& s) {
  const RawSymMat3 m = rotate_raw(r, raw_of(s));
  using T = Fixed<D, std::int32_t, F>;
  return {T::from_raw(m.xx), T::from_raw(m.yy), T::from_raw(m.zz),
          T::from_raw(m.xy), T::from_raw(m.xz), T::from_raw(m.yz)};
}

/// Whether every leading minor is positive, exactly (Sylvester's criterion).
[[nodiscard]] bool is_positive_definite(const RawSymMat3& s);

template <class D, int F>
[[nodiscard]] bool is_positive_definite(const SymMat3<Fixed<D, std::int32_t, F>>& s) {
  return is_positive_definite(raw_of(s));
}

/// Entry (i, j) has the value scaledᵢⱼ · 2^(exponentᵢ + exponentⱼ). Diagonal entries of `scaled`
/// are in [⅛, 1], the others in [−1, 1].
struct EquilibratedSymMat3 {
  SymMat3<Unit> scaled;
  std::array<std::int8_t, 3> exponent{};

  friend constexpr bool operator==(const EquilibratedSymMat3&,
                                   const EquilibratedSymMat3&) = default;
};

/// The inverse of a matrix with `frac_bits` fraction bits. Every entry of `scaled` is the exact one
/// rounded to nearest, so entry (i, j) errs by at most 2^-28 · √(inverseᵢᵢ · inverseⱼⱼ). A matrix
/// that is not positive definite is a programmer's error and gives zero.
[[nodiscard]] EquilibratedSymMat3 inverse_raw(const RawSymMat3& s, int frac_bits);

/// As `inverse_raw`. The unit is one over that of s.
template <class D, int F>
[[nodiscard]] EquilibratedSymMat3 inverse(const SymMat3<Fixed<D, std::int32_t, F>>& s) {
  return inverse_raw(raw_of(s), F);
}

/// ⌊s⁻¹·b · 2^shift⌉ in whole numbers, the nearest bound of int64 when it does not fit; zero when s
/// is not positive definite. −96 ≤ shift ≤ 96.
[[nodiscard]] Vec3<std::int64_t> solve_raw_saturating(const RawSymMat3& s,
                                                      const Vec3<std::int32_t>& b, int shift);

/// The x with s·x = b, each component the exact one rounded to nearest in the format To, or the
/// nearest bound of To. s must be positive definite.
template <class To, class D1, int F1, class D2, int F2>
requires(std::same_as<typename To::Unit, DimensionQuotient<D2, D1>>)
    [[nodiscard]] Vec3<To> solve_saturating(const SymMat3<Fixed<D1, std::int32_t, F1>>& s,
                                            const Vec3<Fixed<D2, std::int32_t, F2>>& b) {
  using Rep = typename To::Representation;
  const Vec3<std::int64_t> x =
      solve_raw_saturating(raw_of(s), {b.x.raw, b.y.raw, b.z.raw}, F1 - F2 + To::frac_bits);
  return {To::from_raw(raw::saturate<Rep>(x.x)), To::from_raw(raw::saturate<Rep>(x.y)),
          To::from_raw(raw::saturate<Rep>(x.z))};
}

}  // namespace lockstone
