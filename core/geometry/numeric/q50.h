// Fine lanes: raw 64-bit lengths with 50 fraction bits, the working format of the collision
// kernels.
//
// A length (20 bits) times a direction (30 bits) is exact in it, so centres, face distances and
// vertices enter without rounding. Range ±2^13 m, resolution 2^-50 m. Every rounding is odd
// (ties away from zero), so a mirrored input gives a mirrored result.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::geometry {

using Fine = std::int64_t;  ///< a length, raw, 2^-50 m

inline constexpr int k_fine_bits = 50;
inline constexpr int k_fine_per_length = k_fine_bits - Length::frac_bits;              // 30
inline constexpr int k_fine_per_displacement = k_fine_bits - Displacement::frac_bits;  // 26

/// Three raw lanes; fine unless said otherwise.
struct RawVec {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;

  friend constexpr bool operator==(const RawVec&, const RawVec&) = default;

  [[nodiscard]] constexpr std::int64_t& operator[](int axis) {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  [[nodiscard]] constexpr std::int64_t operator[](int axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  friend constexpr RawVec operator+(const RawVec& a, const RawVec& b) {
    return {raw::add(a.x, b.x), raw::add(a.y, b.y), raw::add(a.z, b.z)};
  }
  friend constexpr RawVec operator-(const RawVec& a, const RawVec& b) {
    return {raw::subtract(a.x, b.x), raw::subtract(a.y, b.y), raw::subtract(a.z, b.z)};
  }
  constexpr RawVec operator-() const { return {-x, -y, -z}; }
};

/// The raws of a vector's components.
template <class T>
[[nodiscard]] constexpr RawVec raws_of(const Vec3<T>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

/// v / 2^shift, rounded.
[[nodiscard]] constexpr RawVec shifted(const RawVec& v, int shift) {
  return {raw::round_shift(v.x, shift), raw::round_shift(v.y, shift), raw::round_shift(v.z, shift)};
}

/// A length in fine lanes, exact.
[[nodiscard]] constexpr Fine fine(Length length) {
  return Fine{length.raw} * (Fine{1} << k_fine_per_length);
}

[[nodiscard]] constexpr RawVec fine(const Vec3<Length>& v) {
  return {fine(v.x), fine(v.y), fine(v.z)};
}

/// The exact vector of `length` along `direction`.
[[nodiscard]] constexpr RawVec along(const Vec3<Unit>& direction, Length length) {
  return {(direction.x * length).raw, (direction.y * length).raw, (direction.z * length).raw};
}

/// a · c for a coefficient |c| ≤ 2 with 30 fraction bits.
[[nodiscard]] constexpr Fine scaled(Fine a, std::int32_t coefficient) {
  return raw::multiply_shift(a, coefficient, Unit::frac_bits);
}

[[nodiscard]] constexpr RawVec along(const Vec3<Unit>& direction, Fine length) {
  return {scaled(length, direction.x.raw), scaled(length, direction.y.raw),
          scaled(length, direction.z.raw)};
}

/// p · n for a unit vector n.
[[nodiscard]] constexpr Fine dot(const RawVec& p, const Vec3<Unit>& n) {
  return raw::add(raw::add(scaled(p.x, n.x.raw), scaled(p.y, n.y.raw)), scaled(p.z, n.z.raw));
}

/// Body axes to world axes.
[[nodiscard]] constexpr RawVec rotate(const Mat3& m, const RawVec& p) {
  return along(m.x, p.x) + along(m.y, p.y) + along(m.z, p.z);
}

/// The coordinates of `v` along the columns of `m`, exact. |v| < 2^13 m.
[[nodiscard]] constexpr RawVec to_local(const Mat3& m, const Vec3<Length>& v) {
  return {lockstone::dot(m.x, v).raw, lockstone::dot(m.y, v).raw, lockstone::dot(m.z, v).raw};
}

/// The coordinates of a unit vector along the columns of `m`, each rounded once.
[[nodiscard]] constexpr Vec3<Unit> to_local(const Mat3& m, const Vec3<Unit>& v) {
  return rotate_inverse(m, v);
}

[[nodiscard]] constexpr std::int64_t magnitude_of(std::int64_t x) {
  return x < 0 ? -x : x;
}

/// |x| + |y| + |z|: at least the length.
[[nodiscard]] constexpr std::int64_t sum_of_magnitudes(const RawVec& v) {
  return magnitude_of(v.x) + magnitude_of(v.y) + magnitude_of(v.z);
}

/// The same of raws.
template <class T>
[[nodiscard]] constexpr std::int64_t sum_of_magnitudes(const Vec3<T>& v) {
  return sum_of_magnitudes(raws_of(v));
}

/// −1 for negative values, else 1.
[[nodiscard]] constexpr int sign_of(std::int64_t x) {
  return x < 0 ? -1 : 1;
}

[[nodiscard]] constexpr Fine clamp_to(Fine x, Fine bound) {
  return std::clamp(x, -bound, bound);
}

[[nodiscard]] constexpr Vec3<Unit> signed_axis(const Vec3<Unit>& axis, int sign) {
  return sign < 0 ? -axis : axis;
}

/// Three half sizes as fine lengths.
[[nodiscard]] constexpr RawVec half_extents(const Shape& box) {
  return fine(box.size);
}

/// A fine length as a separation: to nearest, saturating at ±128 m.
[[nodiscard]] constexpr Displacement to_separation(Fine length) {
  return Displacement::from_raw(
      raw::saturate<std::int32_t>(raw::round_shift(length, k_fine_per_displacement)));
}

[[nodiscard]] constexpr Fine fine(Displacement separation) {
  return Fine{separation.raw} << k_fine_per_displacement;
}

}  // namespace lockstone::geometry
