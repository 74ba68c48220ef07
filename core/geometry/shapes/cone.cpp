// Cones: size.x is the radius of the base, size.y the height, along y. The centre of mass is the
// origin: the base is at y = −h/4, the apex at 3h/4.
#include <algorithm>

#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/shapes/rim_shape.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/geometry/shapes/sloping_side.h"
#include "core/math/roots.h"

namespace lockstone {
namespace geometry {
namespace {

/// r² h, 60 fraction bits; times π/3 the volume.
UInt128 cone_product(const Sizes& size) {
  return multiply_wide(square(raw_of(size.x)), raw_of(size.y));
}

Fine cone_base_height(const Sizes& size) {
  return -fine(size.y) / 4;
}

Fine cone_apex_height(const Sizes& size) {
  return fine(size.y) - fine(size.y) / 4;
}

Disc cone_base(const Sizes& size) {
  return {cone_base_height(size), size.x};
}

/// The side's outward normal in the plane of x and y: (h, r) / √(h² + r²).
struct SideNormal {
  Unit out;
  Unit up;
};

SideNormal cone_side(const Sizes& size) {
  const Vec3<Unit> n = direction_of(size.y.raw, size.x.raw, 0);
  return {n.x, n.y};
}

/// max(3h/4, √(r² + h²/16)).
Length cone_bounding_radius(const Shape& shape) {
  const std::uint64_t quarter = (raw_of(shape.size.y) + 3) / 4;
  return max(
      Length::from_raw(static_cast<std::int32_t>(raw_of(shape.size.y) - raw_of(shape.size.y) / 4)),
      root_up(square(raw_of(shape.size.x)) + square(quarter)));
}

/// min(h/4, 3/4 · h r / √(h² + r²)), rounded down.
Length cone_inner_radius(const Shape& shape) {
  const std::int64_t side =
      (3 * (cone_side(shape.size).out * shape.size.x).raw / 4) >> Unit::frac_bits;
  return max(min(shape.size.y / 4,
                 Length::from_raw(static_cast<std::int32_t>(side)) - Length::from_raw(1)),
             Length::from_raw(1));
}

Fine cone_reach(const Shape& shape, const Vec3<Unit>& n) {
  const Fine apex = scaled(cone_apex_height(shape.size), n.y.raw);
  const Fine rim =
      scaled(cone_base_height(shape.size), n.y.raw) + rim_reach(shape.size.x, n.x, n.z);
  return std::max(apex, rim);
}

Sizes cone_extents(const Shape& shape, const Mat3& rotation) {
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<Unit> n{rotation.x[axis], rotation.y[axis], rotation.z[axis]};
    const Fine reach = std::max(cone_reach(shape, n), cone_reach(shape, -n));
    result[axis] = rounded_up(reach + shape.size.x.raw + 2);  // the rounding of root and products
  }
  return result;
}

Mass cone_mass(const Shape& shape, Density density) {
  return mass_with_factor(cone_product(shape.size), density, k_third_pi, 61);
}

BlockFloat cone_volume(const Shape& shape) {
  return volume_with_factor(cone_product(shape.size), k_third_pi, 61);
}

/// About the axis 3r²/10, across it 3r²/20 + 3h²/80.
Vec3<Unit> cone_inertia(const ScaledSizes& size) {
  const std::uint64_t rr = square(size[0]), hh = square(size[1]);
  const UInt128 weighed = multiply_wide(12, rr) + multiply_wide(3, hh);
  const Unit across = moment_of(round_divide(weighed, std::uint64_t{80} << 30));
  return {across, moment_share(3 * rr, 10), across};
}

bool cone_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  const Fine height = fine(point.y);
  if (height < cone_base_height(shape.size) - fine(slack)) return false;
  const SideNormal side = cone_side(shape.size);
  const Fine beyond = (distance_from_axis(point) * side.out).raw +
                      scaled(height - cone_apex_height(shape.size), side.up.raw);
  return beyond <= fine(slack);
}

/// Whether n looks more along the base's normal than along the side's.
bool shows_base(const Sizes& size, const Vec3<Unit>& n) {
  const SideNormal side = cone_side(size);
  const Fine flat = rim_reach(Length::from_raw(1), n.x, n.z);  // 30 fraction bits
  const std::int64_t along_side = flat * side.out.raw + std::int64_t{n.y.raw} * side.up.raw;
  return -(std::int64_t{n.y.raw} << Unit::frac_bits) > along_side;
}

Vec3<Unit> cone_face_along(const Shape& shape, const Vec3<Unit>& axis) {
  if (shows_base(shape.size, axis)) return -Mat3{}.y;
  const SideNormal side = cone_side(shape.size);
  Vec3<Unit> flat = direction_of(axis.x.raw, 0, axis.z.raw);
  if (flat == Vec3<Unit>{}) flat.x = Unit::from_integer(1);  // at the apex all sides are alike
  return {rounded<Unit>(flat.x * side.out), side.up, rounded<Unit>(flat.z * side.out)};
}

void cone_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  const Sizes& size = shape.shape.size;
  if (shows_base(size, rotate_inverse(shape.rotation, n)))
    return add_disc(shape, cone_base(size), -1, n, 0, out);
  out.add(deepest_of(shape, cone_base(size), n), k_disc_deepest);
  out.add(rotate(shape.rotation, RawVec{0, cone_apex_height(size), 0}), k_second_disc);
}

/// A smaller cone of the same form about the same centre of mass.
Shape cone_scaled(const Shape& shape, Unit share) {
  return resized(shape, scaled_sizes(shape.size, share));
}

Shape cone_shrunk(const Shape& shape, Length depth) {
  const Length inner = cone_inner_radius(shape);
  const Length left = inner - min(depth, inner);
  return cone_scaled(shape, Unit::from_raw(static_cast<std::int32_t>(
                                (std::int64_t{left.raw} << Unit::frac_bits) / inner.raw)));
}

void cone_core(const PosedShape& shape, ConvexCore& core) {
  const Sizes& size = shape.shape.size;
  const RawVec base = along(shape.rotation.y, cone_base_height(size));
  const RawVec apex = along(shape.rotation.y, cone_apex_height(size));
  core.rims = {2, shape.rotation.x, shape.rotation.z, {base, apex}, {size.x, Length{}}};
  for (int k = 0; k < 3; ++k)
    core.extent[k] = std::max(magnitude_of(base[k]) + fine(size.x), magnitude_of(apex[k]));
}

// Rays --------------------------------------------------------------------------------------------

ShapeRayHit cone_ray(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                     const Vec3<Length>& translation) {
  const AxisRay ray{to_local(rotation, origin), to_local(rotation, translation)};
  const SideNormal side = cone_side(shape.size);
  const auto distance = static_cast<Fine>(norm(ray.start.x, 0, ray.start.z));
  const Fine beyond = scaled(distance, side.out.raw) +
                      scaled(ray.start.y - cone_apex_height(shape.size), side.up.raw);
  if (beyond <= 0 && ray.start.y >= cone_base_height(shape.size)) return {true, {}, {}};
  const Fine apex = cone_apex_height(shape.size);
  RimHit best = meet_side({side.out, side.up, apex, 0}, ray, {cone_base_height(shape.size), apex});
  take_earlier(best, meet_disc(ray, cone_base(shape.size), -1));
  return ray_hit(best, rotation);
}

}  // namespace

const ShapeTraits k_cone{
    .size_names = {"radius", "height", ""},
    .size_count = 2,
    .bounding_radius = cone_bounding_radius,
    .inner_radius = cone_inner_radius,
    .half_extents = cone_extents,
    .mass = cone_mass,
    .volume = cone_volume,
    .inertia = cone_inertia,
    .reach = cone_reach,
    .holds = cone_holds,
    .face_along = cone_face_along,
    .vertex_at = no_vertex_at,
    .vertices = no_vertices,
    .shrunk = cone_shrunk,
    .shortened = cone_scaled,
    .make_core = cone_core,
    .below_plane = below_feature,
    .cast_ray = cone_ray,
    .collide = collide_convex,
    .find_feature = cone_feature,
    .with_round_ends = nullptr,
};

}  // namespace geometry

Shape Shape::cone(Length height, Length radius) {
  return {ShapeKind::cone, {radius, height, {}}, {}};
}

}  // namespace lockstone
