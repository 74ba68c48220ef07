#include <lockstone/rotation.h>
#include <lockstone/trigonometry.h>

#include "core/math/roots.h"
#include "core/math/rotation_log.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

using Product = Vec3<Fixed<Scalar, std::int64_t, 60>>;  // of two unit vectors

constexpr std::int64_t k_one_q60 = std::int64_t{1} << 60;
constexpr Vec3<Unit> k_axes[3] = {{Unit::from_integer(1), {}, {}},
                                  {{}, Unit::from_integer(1), {}},
                                  {{}, {}, Unit::from_integer(1)}};

/// A unit vector at a right angle to a unit vector; zero of zero.
Vec3<Unit> perpendicular(const Vec3<Unit>& u) {
  int least = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (abs(u[axis]) < abs(u[least])) least = axis;
  }
  return direction_of(cross(k_axes[least], u));
}

std::uint64_t size_of(const Product& v) {
  return norm(v.x.raw, v.y.raw, v.z.raw);
}

/// The way from one orientation to another. `angle` is that of the rotation, 32 fraction bits.
struct Arc {
  Quat from;
  Quat to;
  std::int64_t angle = 0;
};

/// With the sign of `to` that makes the way the shorter one.
Arc arc_between(const Quat& a, const Quat& b) {
  const Product turn{b.x * a.w - b.w * a.x + b.z * a.y - b.y * a.z,
                     b.y * a.w - b.w * a.y + b.x * a.z - b.z * a.x,
                     b.z * a.w - b.w * a.z + b.y * a.x - b.x * a.y};  // b · a*, exact
  const std::int64_t cosine = (a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w).raw;
  const bool is_longer = cosine < 0;
  const RotationComponent half = fine_arc(size_of(turn), is_longer ? -cosine : cosine);
  return {a, is_longer ? Quat{-b.x, -b.y, -b.z, -b.w} : b, 2 * half.raw};
}

/// The orientation `part` of the angle along the way. 0 < part < angle.
///
/// from · sin((angle − part)/2) + to · sin(part/2), made a unit: Shoemake's division by
/// sin(angle/2) falls out. Sines of small angles are as the angles, and those have more bits.
Quat along(const Arc& arc, std::int64_t part) {
  LKS_ASSERT(part > 0 && part < arc.angle);
  constexpr std::int64_t k_small = std::int64_t{1} << 18;  // 2^-14 rad: sines within 2^-45
  std::int64_t weight_from = arc.angle - part, weight_to = part;
  if (arc.angle > k_small) {
    weight_from = half_sin_cos(RotationComponent::from_raw(weight_from)).sin;
    weight_to = half_sin_cos(RotationComponent::from_raw(weight_to)).sin;
  }
  const auto blend = [&](Unit a, Unit b) { return weight_from * a.raw + weight_to * b.raw; };
  return direction_of(blend(arc.from.x, arc.to.x), blend(arc.from.y, arc.to.y),
                      blend(arc.from.z, arc.to.z), blend(arc.from.w, arc.to.w));
}

}  // namespace

namespace rotation_detail {

Angle angle(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  return atan2_raw(static_cast<std::int64_t>(size_of(cross(a, b))), dot(a, b).raw);
}

// With c = cos θ, (axis · sin θ, 1 + c) and (axis · (1 − c), sin θ) are multiples of the rotation;
// either is at least √2 long where it is used. The bits are those of a Quat, at most ±2.
Quat between(const Vec3<Unit>& from, const Vec3<Unit>& to) {
  const Product normal = cross(from, to);
  const std::int64_t cosine = dot(from, to).raw;
  const auto unit = [](std::int64_t q60) {
    return Unit::from_raw(raw::saturate<std::int32_t>(raw::round_shift(q60, 30)));
  };
  if (cosine >= 0)
    return normalized(
        Quat{unit(normal.x.raw), unit(normal.y.raw), unit(normal.z.raw), unit(k_one_q60 + cosine)});
  const auto sine = static_cast<std::int64_t>(size_of(normal));
  const Vec3<Unit> axis = sine == 0 ? perpendicular(from) : direction_of(normal);
  const Unit size = unit(k_one_q60 - cosine);
  return normalized(
      Quat{scaled(axis.x, size), scaled(axis.y, size), scaled(axis.z, size), unit(sine)});
}

Quat look(const Vec3<Unit>& forward, const Vec3<Unit>& up) {
  if (forward == Vec3<Unit>{}) return {};
  const Product side = cross(up, forward);
  const Vec3<Unit> x = side == Product{} ? perpendicular(forward) : direction_of(side);
  return orientation_of({x, direction_of(cross(forward, x)), forward});
}

}  // namespace rotation_detail

Angle angle_between(const Quat& a, const Quat& b) {
  const std::int64_t angle = arc_between(a, b).angle;
  constexpr int k_shift = RotationComponent::frac_bits - Angle::frac_bits;
  return Angle::from_raw(static_cast<std::int32_t>(raw::round_shift(angle, k_shift)));
}

Quat slerp(const Quat& a, const Quat& b, Unit t) {
  constexpr Unit one = Unit::from_integer(1);
  if (t <= Unit{}) return a;
  if (t >= one) return b;
  const Arc arc = arc_between(a, b);
  const std::int64_t part = raw::multiply_shift(arc.angle, t.raw, Unit::frac_bits);
  if (part == 0) return a;
  return part == arc.angle ? b : along(arc, part);
}

Quat rotate_toward(const Quat& from, const Quat& to, Angle most) {
  if (most <= Angle{}) return from;
  const Arc arc = arc_between(from, to);
  const std::int64_t part = std::int64_t{most.raw} * 32;  // 32 fraction bits
  return part >= arc.angle ? to : along(arc, part);
}

}  // namespace lockstone
