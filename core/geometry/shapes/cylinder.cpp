// Cylinders: size.x is the radius, size.y half the height, along y.
#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/query/ray_round.h"
#include "core/geometry/shapes/rim_shape.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/math/roots.h"

namespace lockstone {
namespace geometry {
namespace {

/// 2 r² h, 60 fraction bits; times π the volume.
UInt128 cylinder_product(const Sizes& size) {
  return multiply_wide(square(raw_of(size.x)), 2 * raw_of(size.y));
}

Length cylinder_bounding_radius(const Shape& shape) {
  return root_up(norm_squared(shape.size));
}

Length cylinder_inner_radius(const Shape& shape) {
  return min(shape.size.x, shape.size.y);
}

Fine cylinder_reach(const Shape& shape, const Vec3<Unit>& n) {
  return (shape.size.y * abs(n.y)).raw + rim_reach(shape.size.x, n.x, n.z);
}

Sizes cylinder_extents(const Shape& shape, const Mat3& rotation) {
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<Unit> n{rotation.x[axis], rotation.y[axis], rotation.z[axis]};
    result[axis] = rounded_up(cylinder_reach(shape, n) + shape.size.x.raw);  // the root's rounding
  }
  return result;
}

Mass cylinder_mass(const Shape& shape, Density density) {
  return mass_with_factor(cylinder_product(shape.size), density, k_pi, 61);
}

BlockFloat cylinder_volume(const Shape& shape) {
  return volume_with_factor(cylinder_product(shape.size), k_pi, 61);
}

/// About the axis r²/2, across it r²/4 + h²/3.
Vec3<Unit> cylinder_inertia(const ScaledSizes& size) {
  const std::uint64_t rr = square(size[0]), hh = square(size[1]);
  const Unit across = moment_share(3 * rr + 4 * hh, 12);
  return {across, moment_share(rr, 2), across};
}

bool cylinder_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  return abs(point.y) <= shape.size.y + slack && distance_from_axis(point) <= shape.size.x + slack;
}

Disc cylinder_end(const Sizes& size, int sign) {
  return {sign * fine(size.y), size.x};
}

/// An end, when the direction is less than 45° from the axis.
bool shows_end(const Vec3<Unit>& n) {
  return std::int64_t{2} * (n.y * n.y).raw > std::int64_t{1} << 60;
}

Vec3<Unit> cylinder_face_along(const Shape& /*shape*/, const Vec3<Unit>& axis) {
  if (shows_end(axis)) return signed_axis(Mat3{}.y, sign_of(axis.y.raw));
  return direction_of(axis.x.raw, 0, axis.z.raw);
}

void cylinder_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  const Sizes& size = shape.shape.size;
  const Vec3<Unit> local = rotate_inverse(shape.rotation, n);
  if (shows_end(local)) {
    const int sign = sign_of(local.y.raw);
    return add_disc(shape, cylinder_end(size, sign), sign, n, sign < 0 ? 0 : k_second_disc, out);
  }
  out.add(deepest_of(shape, cylinder_end(size, -1), n), k_disc_deepest);
  out.add(deepest_of(shape, cylinder_end(size, 1), n), k_second_disc + k_disc_deepest);
}

Shape cylinder_with_round_ends(const Shape& shape) {
  return Shape::capsule(shape.size.y, shape.size.x);
}

Shape cylinder_shrunk(const Shape& shape, Length depth) {
  return resized(shape, {shape.size.x - depth, shape.size.y - depth, {}});
}

Shape cylinder_shortened(const Shape& shape, Unit share) {
  return resized(shape, scaled_sizes(shape.size, share));
}

void cylinder_core(const PosedShape& shape, ConvexCore& core) {
  const Sizes& size = shape.shape.size;
  const RawVec end = along(shape.rotation.y, size.y);
  core.rims = {2, shape.rotation.x, shape.rotation.z, {-end, end}, {size.x, size.x}};
  for (int k = 0; k < 3; ++k)
    core.extent[k] = magnitude_of(end[k]) + fine(size.x);
}

/// The side is that of an endless cylinder, as far as the ends.
ShapeRayHit cylinder_ray(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                         const Vec3<Length>& translation) {
  constexpr Fine k_seam = Fine{1} << (k_fine_bits - 30);  // no ray slips between side and end
  const AxisRay ray{to_local(rotation, origin), to_local(rotation, translation)};
  const RawVec flat{ray.start.x, 0, ray.start.z};
  const auto distance = norm(flat.x, 0, flat.z);
  const Fine half = fine(shape.size.y), radius = fine(shape.size.x);
  if (magnitude_of(ray.start.y) <= half && distance <= static_cast<std::uint64_t>(radius))
    return {true, {}, {}};
  RimHit best;
  const RoundHit side = first_meeting(flat, {ray.way.x, 0, ray.way.z}, radius);
  if (side.hit && distance > static_cast<std::uint64_t>(radius)) {
    const RawVec at = ray_point(ray, side.fraction);
    if (magnitude_of(at.y) <= half + k_seam) best = {true, side.fraction, {at.x, 0, at.z}};
  }
  take_earlier(best, meet_disc(ray, cylinder_end(shape.size, 1), 1));
  take_earlier(best, meet_disc(ray, cylinder_end(shape.size, -1), -1));
  return ray_hit(best, rotation);
}

}  // namespace

const ShapeTraits k_cylinder{
    .size_names = {"radius", "half_height", ""},
    .size_count = 2,
    .bounding_radius = cylinder_bounding_radius,
    .inner_radius = cylinder_inner_radius,
    .half_extents = cylinder_extents,
    .mass = cylinder_mass,
    .volume = cylinder_volume,
    .inertia = cylinder_inertia,
    .reach = cylinder_reach,
    .holds = cylinder_holds,
    .face_along = cylinder_face_along,
    .vertex_at = no_vertex_at,
    .vertices = no_vertices,
    .shrunk = cylinder_shrunk,
    .shortened = cylinder_shortened,
    .make_core = cylinder_core,
    .below_plane = below_feature,
    .cast_ray = cylinder_ray,
    .collide = collide_convex,
    .find_feature = cylinder_feature,
    .with_round_ends = cylinder_with_round_ends,
};

}  // namespace geometry

Shape Shape::cylinder(Length half_height, Length radius) {
  return {ShapeKind::cylinder, {radius, half_height, {}}, {}};
}

}  // namespace lockstone
