// Rounded boxes: all points within a radius, the fourth size, of a box whose half extents are the
// other sizes.
#include <algorithm>

#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/contact/feature/contact_feature.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/convex/polytope_box.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/query/ray_rounded.h"
#include "core/geometry/shapes/ball_swept.h"
#include "core/geometry/shapes/box_core.h"
#include "core/geometry/shapes/rim_shape.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/math/roots.h"
#include "core/math/soft_real.h"

namespace lockstone {
namespace geometry {
namespace {

Length rounded_box_radius(const Shape& shape) {
  return shape.fourth_size();
}

Length rounded_box_bounding_radius(const Shape& shape) {
  return root_up(norm_squared(shape.size)) + rounded_box_radius(shape);
}

Length rounded_box_inner_radius(const Shape& shape) {
  return min(min(shape.size.x, shape.size.y), shape.size.z) + rounded_box_radius(shape);
}

Fine rounded_box_reach(const Shape& shape, const Vec3<Unit>& n) {
  return box_reach(shape, n) + fine(rounded_box_radius(shape));
}

Sizes rounded_box_extents(const Shape& shape, const Mat3& rotation) {
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<Unit> n{rotation.x[axis], rotation.y[axis], rotation.z[axis]};
    result[axis] = rounded_up(rounded_box_reach(shape, n));
  }
  return result;
}

// Mass --------------------------------------------------------------------------------------------

/// Half extents of the core, and the radius, in any unit.
struct RoundedSizes {
  SoftReal a, b, c, r;
};

SoftReal third_pi() {
  return SoftReal::of(static_cast<std::int64_t>(k_third_pi), -61);
}

/// 8 (abc + r(ab + bc + ca)) + π/3 · r² (6(a + b + c) + 4r): the box, slabs on its faces, quarters
/// of cylinders along its edges, and a ball in eight parts.
SoftReal volume_of(const RoundedSizes& s) {
  const auto& [a, b, c, r] = s;
  return 8 * (a * b * c + r * (a * b + b * c + c * a)) +
         third_pi() * r * r * (6 * (a + b + c) + 4 * r);
}

/// ∫x² dV times 30: over the part between x = −a and a, whose section is a rounded rectangle, and
/// over the caps beyond, whose sections are rectangles rounded by √(r² − (x − a)²).
SoftReal square_integral(const RoundedSizes& s) {
  const auto& [a, b, c, r] = s;
  const SoftReal aa = a * a, rr = r * r, bc = b * c, sides = b + c;
  const SoftReal flat = 80 * aa * a * (bc + r * sides) + 240 * bc * a * r * (a + r) +
                        80 * bc * rr * r + 160 * sides * a * rr * r;
  const SoftReal round =
      20 * aa * a + sides * (60 * aa + 15 * rr) + 40 * aa * r + 30 * a * rr + 8 * rr * r;
  return flat + 3 * third_pi() * rr * round;
}

RoundedSizes rounded_sizes(const Shape& shape) {
  const auto length = [](Length x) { return SoftReal::of(x.raw, -Length::frac_bits); };
  return {length(shape.size.x), length(shape.size.y), length(shape.size.z),
          length(rounded_box_radius(shape))};
}

Mass rounded_box_mass(const Shape& shape, Density density) {
  const SoftReal factor = SoftReal::of(density.raw, -Density::frac_bits);
  return Mass::from_raw(fixed_point(volume_of(rounded_sizes(shape)) * factor, Mass::frac_bits));
}

BlockFloat rounded_box_volume(const Shape& shape) {
  const SoftReal volume = volume_of(rounded_sizes(shape));
  return block_float(static_cast<std::uint64_t>(volume.mantissa), volume.exponent);
}

Vec3<Unit> rounded_box_inertia(const ScaledSizes& size) {
  const auto part = [&](std::size_t i) {
    return SoftReal::of(static_cast<std::int64_t>(size[i]), -30);
  };
  const SoftReal a = part(0), b = part(1), c = part(2), r = part(3);
  const SoftReal mass = 30 * volume_of({a, b, c, r});
  const SoftReal x = square_integral({a, b, c, r}), y = square_integral({b, c, a, r}),
                 z = square_integral({c, a, b, r});
  const auto moment = [&](SoftReal sum) {
    return moment_of(static_cast<std::uint64_t>(fixed_point(sum / mass, Unit::frac_bits)));
  };
  return {moment(y + z), moment(z + x), moment(x + y)};
}

// Places ------------------------------------------------------------------------------------------

bool rounded_box_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  Vec3<Length> from_core;
  for (int i = 0; i < 3; ++i)
    from_core[i] = point[i] - clamp(point[i], -shape.size[i], shape.size[i]);
  return is_in_ball(from_core, rounded_box_radius(shape) + slack);
}

/// The flat part's normal where the axis leans from it by less than 1/32; else the axis, since each
/// direction is that of the round part somewhere.
Vec3<Unit> rounded_box_face_along(const Shape& shape, const Vec3<Unit>& axis) {
  const Vec3<Unit> face = box_face_along(shape, axis);
  constexpr std::int64_t k_near = (std::int64_t{1} << 60) - (std::int64_t{1} << 49);
  return lockstone::dot(face, axis).raw >= k_near ? face : axis;
}

/// The radius shrinks first, then the core.
Shape rounded_box_shrunk(const Shape& shape, Length depth) {
  const Length least = Length::from_raw(1);
  const Length radius = max(rounded_box_radius(shape) - depth, least);
  const Length rest = depth - (rounded_box_radius(shape) - radius);
  return Shape::rounded_box(max(shape.size.x - rest, least), max(shape.size.y - rest, least),
                            max(shape.size.z - rest, least), radius);
}

Shape rounded_box_shortened(const Shape& shape, Unit share) {
  return resized(shape, scaled_sizes(shape.size, share));
}

void rounded_box_core(const PosedShape& shape, ConvexCore& core) {
  box_core(shape, core);
  core.radius = rounded_box_radius(shape.shape);
}

void rounded_box_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  const BoxPolytope box(shape.shape.size, rounded_box_radius(shape.shape));
  const Polytope view = box.view();
  find_feature({shape.shape, shape.rotation, &view}, n, out);
}

ShapeRayHit rounded_box_ray(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                            const Vec3<Length>& translation) {
  const BoxPolytope box(shape.size, rounded_box_radius(shape));
  const Polytope view = box.view();
  return cast_ray_at_rounded(view, rotation, origin, translation);
}

}  // namespace

const ShapeTraits k_rounded_box{
    .size_names = {"half_x", "half_y", "half_z", "radius"},
    .size_count = 4,
    .core_radius = rounded_box_radius,
    .bounding_radius = rounded_box_bounding_radius,
    .inner_radius = rounded_box_inner_radius,
    .half_extents = rounded_box_extents,
    .mass = rounded_box_mass,
    .volume = rounded_box_volume,
    .inertia = rounded_box_inertia,
    .reach = rounded_box_reach,
    .holds = rounded_box_holds,
    .face_along = rounded_box_face_along,
    .vertex_at = box_vertex_at,
    .vertices = box_vertices,
    .shrunk = rounded_box_shrunk,
    .shortened = rounded_box_shortened,
    .make_core = rounded_box_core,
    .below_plane = below_feature,
    .cast_ray = rounded_box_ray,
    .collide = collide_convex,
    .find_feature = rounded_box_feature,
};

}  // namespace geometry

Shape Shape::rounded_box(Length half_x, Length half_y, Length half_z, Length radius) {
  const AssetId fourth{static_cast<std::uint64_t>(static_cast<std::uint32_t>(radius.raw))};
  return {ShapeKind::rounded_box, {half_x, half_y, half_z}, fourth};
}

}  // namespace lockstone
