// Rotations for the game's own rules: between directions, towards a direction, part of the way.
//
// A rotation about an axis is from_axis_angle in quat.h, one after another normalized(multiply(a,
// b)). How they are computed, bit by bit: docs/explanation/numerics.md.
#pragma once

#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/transform.h>
#include <lockstone/vector_math.h>

namespace lockstone {

namespace rotation_detail {

/// Of unit vectors, or zero.
[[nodiscard]] Angle angle(const Vec3<Unit>& a, const Vec3<Unit>& b);
[[nodiscard]] Quat between(const Vec3<Unit>& from, const Vec3<Unit>& to);
[[nodiscard]] Quat look(const Vec3<Unit>& forward, const Vec3<Unit>& up);

}  // namespace rotation_detail

/// q·v·q*: a vector of the body as seen in the world. Within 2^-28 of |v|, and half a last place.
/// The result must fit. For many vectors, `to_matrix` once is cheaper.
template <class D, class Rep, int F>
[[nodiscard]] Vec3<Fixed<D, Rep, F>> rotate(const Quat& q, const Vec3<Fixed<D, Rep, F>>& v) {
  if constexpr (sizeof(Rep) == 4) {
    return rotate(to_matrix(q), v);
  } else {
    using T = Fixed<D, Rep, F>;
    const Vec3<Position> turned = rotate(to_matrix(q), vector_detail::words(v));
    return {T::from_raw(turned.x.raw), T::from_raw(turned.y.raw), T::from_raw(turned.z.raw)};
  }
}

/// q*·v·q: a vector of the world as the body sees it. Bounds as for `rotate`.
template <class D, class Rep, int F>
[[nodiscard]] Vec3<Fixed<D, Rep, F>> rotate_inverse(const Quat& q,
                                                    const Vec3<Fixed<D, Rep, F>>& v) {
  return rotate(conjugate(q), v);
}

/// The angle between two vectors of any length, 0 … π, within 2^-26 rad; 0 if one is zero.
template <class D1, class R1, int F1, class D2, class R2, int F2>
[[nodiscard]] Angle angle_between(const Vec3<Fixed<D1, R1, F1>>& a,
                                  const Vec3<Fixed<D2, R2, F2>>& b) {
  return rotation_detail::angle(normalized(a), normalized(b));
}

/// The angle of the rotation that takes one orientation to the other, 0 … π, within 2^-27 rad
/// (measured: 0.53).
[[nodiscard]] Angle angle_between(const Quat& a, const Quat& b);

/// The shortest rotation from one direction to another; the lengths of the vectors do not matter.
/// It takes the one onto the other within 2^-27 rad. Opposite directions: half a turn about some
/// axis at a right angle to them. A zero vector: no rotation.
template <class D1, class R1, int F1, class D2, class R2, int F2>
[[nodiscard]] Quat from_directions(const Vec3<Fixed<D1, R1, F1>>& from,
                                   const Vec3<Fixed<D2, R2, F2>>& to) {
  return rotation_detail::between(normalized(from), normalized(to));
}

/// The orientation whose z axis points along `forward` and whose y axis is as near to `up` as that
/// allows; x is to the left, for one who looks along z. Axes within 2^-27 rad. Along `up` itself
/// the body is turned about it in some way; a zero `forward` gives no rotation.
template <class D1, class R1, int F1, class D2, class R2, int F2>
[[nodiscard]] Quat look_rotation(const Vec3<Fixed<D1, R1, F1>>& forward,
                                 const Vec3<Fixed<D2, R2, F2>>& up) {
  return rotation_detail::look(normalized(forward), normalized(up));
}

/// With y up.
template <class D, class R, int F>
[[nodiscard]] Quat look_rotation(const Vec3<Fixed<D, R, F>>& forward) {
  return look_rotation(forward, Vec3<Unit>{{}, Unit::from_integer(1), {}});
}

/// The part t of the rotation from a to b, at constant speed, the shorter way round; t is clamped
/// to 0 … 1, where the results are a and b themselves, bit for bit. Components within 2^-29. Of two
/// ways of half a turn it takes the one without a change of sign. Source: Ken Shoemake, "Animating
/// rotation with quaternion curves", SIGGRAPH 1985.
[[nodiscard]] Quat slerp(const Quat& a, const Quat& b, Unit t);

/// `from`, turned towards `to` by at most `most`, the shorter way round; `to` itself, bit for bit,
/// once it is that near. Components within 2^-29. Not turned where `most` is not above 0.
[[nodiscard]] Quat rotate_toward(const Quat& from, const Quat& to, Angle most);

}  // namespace lockstone
