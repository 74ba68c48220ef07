// Unit quaternions: orientations.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// x·i + y·j + z·k + w, of norm 1 within 2^-28. A body vector v is q·v·q* in the world.
struct Quat {
  Unit x{};
  Unit y{};
  Unit z{};
  Unit w = Unit::from_integer(1);

  friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

/// Rotation matrix: three columns, the world directions of the body's axes.
struct Mat3 {
  Vec3<Unit> x{Unit::from_integer(1), {}, {}};
  Vec3<Unit> y{{}, Unit::from_integer(1), {}};
  Vec3<Unit> z{{}, {}, Unit::from_integer(1)};

  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;

  [[nodiscard]] constexpr const Vec3<Unit>& column(int axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
};

/// The matrix of a unit quaternion; each entry is rounded once, error ≤ 2^-30 + the norm's error.
[[nodiscard]] constexpr Mat3 to_matrix(const Quat& q) {
  using Product = Fixed<Scalar, std::int64_t, 60>;
  constexpr Product half = Product::from_raw(std::int64_t{1} << 59);
  const auto entry = [](Product sum) {
    return Unit::from_raw(static_cast<std::int32_t>(raw::round_shift(sum.raw, 29)));  // 2·sum
  };
  const Product xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const Product xy = q.x * q.y, yz = q.y * q.z, zx = q.z * q.x;
  const Product wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{entry(half - yy - zz), entry(xy + wz), entry(zx - wy)},
          {entry(xy - wz), entry(half - zz - xx), entry(yz + wx)},
          {entry(zx + wy), entry(yz - wx), entry(half - xx - yy)}};
}

/// a · b, each component rounded once; not normalised.
[[nodiscard]] constexpr Quat multiply(const Quat& a, const Quat& b) {
  return {rounded<Unit>(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y),
          rounded<Unit>(a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x),
          rounded<Unit>(a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w),
          rounded<Unit>(a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z)};
}

[[nodiscard]] constexpr Quat conjugate(const Quat& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

/// Body to world: m·v, each component rounded once.
template <class D, int F>
[[nodiscard]] constexpr Vec3<Fixed<D, std::int32_t, F>> rotate(
    const Mat3& m, const Vec3<Fixed<D, std::int32_t, F>>& v) {
  using T = Fixed<D, std::int32_t, F>;
  return {rounded<T>(m.x.x * v.x + m.y.x * v.y + m.z.x * v.z),
          rounded<T>(m.x.y * v.x + m.y.y * v.y + m.z.y * v.z),
          rounded<T>(m.x.z * v.x + m.y.z * v.y + m.z.z * v.z)};
}

/// a · b, each entry rounded once.
[[nodiscard]] constexpr Mat3 multiply(const Mat3& a, const Mat3& b) {
  return {rotate(a, b.x), rotate(a, b.y), rotate(a, b.z)};
}

[[nodiscard]] constexpr Mat3 transposed(const Mat3& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}

/// World to body: mᵀ·v, each component rounded once.
template <class D, int F>
[[nodiscard]] constexpr Vec3<Fixed<D, std::int32_t, F>> rotate_inverse(
    const Mat3& m, const Vec3<Fixed<D, std::int32_t, F>>& v) {
  using T = Fixed<D, std::int32_t, F>;
  return {rounded<T>(dot(m.x, v)), rounded<T>(dot(m.y, v)), rounded<T>(dot(m.z, v))};
}

/// `q` scaled to norm 1. The zero quaternion becomes the identity. Error ≤ 2^-30 a component.
[[nodiscard]] Quat normalized(const Quat& q);

/// Rotation by `angle` about the unit vector `axis`.
[[nodiscard]] Quat from_axis_angle(const Vec3<Unit>& axis, Angle angle);

}  // namespace lockstone
