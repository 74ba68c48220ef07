// Tapered capsules, the hulls of two balls: size.x is the radius of the lower one, size.y the
// distance of their centres, along y, size.z the radius of the upper one. The centre of mass is the
// origin.
#include <algorithm>

#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/taper_point_gap.h"
#include "core/geometry/query/ray_round.h"
#include "core/geometry/shapes/ball_swept.h"
#include "core/geometry/shapes/rim_shape.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/geometry/shapes/sloping_side.h"
#include "core/geometry/shapes/tapered_ends.h"
#include "core/math/roots.h"

namespace lockstone {
namespace geometry {
namespace {

Length tapered_bounding_radius(const Shape& shape) {
  const TaperedEnds ends = tapered_ends(shape.size);
  const Fine most = std::max(fine(ends.low_radius) - ends.low, fine(ends.high_radius) + ends.high);
  return rounded_up(most);
}

/// Where the side is nearest to the centre of mass, rounded down.
Length tapered_inner_radius(const Shape& shape) {
  const TaperedEnds ends = tapered_ends(shape.size);
  const Fine side = fine(ends.low_radius) + scaled(ends.low, ends.slope().raw);
  return max(Length::from_raw(static_cast<std::int32_t>(side >> k_fine_per_length) - 1),
             Length::from_raw(1));
}

Fine tapered_reach(const Shape& shape, const Vec3<Unit>& n) {
  const TaperedEnds ends = tapered_ends(shape.size);
  return std::max(fine(ends.low_radius) + scaled(ends.low, n.y.raw),
                  fine(ends.high_radius) + scaled(ends.high, n.y.raw));
}

Sizes tapered_extents(const Shape& shape, const Mat3& rotation) {
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<Unit> n{{}, rotation.y[axis], {}};
    const Fine rounding = 2;
    result[axis] =
        rounded_up(std::max(tapered_reach(shape, n), tapered_reach(shape, -n)) + rounding);
  }
  return result;
}

TaperedMass tapered_mass_of(const Sizes& size) {
  return tapered_mass(raw_of(size.x), raw_of(size.y), raw_of(size.z));
}

/// R² M, 60 fraction bits.
UInt128 tapered_product(const TaperedMass& mass) {
  return multiply_wide(square(mass.radius), mass.length);
}

/// π/3 · the share of R² M.
std::uint64_t tapered_factor(const TaperedMass& mass) {
  return round_shift(multiply_wide(static_cast<std::uint64_t>(mass.volume), k_third_pi), 61).low;
}

Mass tapered_mass(const Shape& shape, Density density) {
  const TaperedMass mass = tapered_mass_of(shape.size);
  return mass_with_factor(tapered_product(mass), density, tapered_factor(mass), k_tapered_bits);
}

BlockFloat tapered_volume(const Shape& shape) {
  const TaperedMass mass = tapered_mass_of(shape.size);
  return volume_with_factor(tapered_product(mass), tapered_factor(mass), k_tapered_bits);
}

Vec3<Unit> tapered_inertia(const ScaledSizes& size) {
  const TaperedMass mass = geometry::tapered_mass(size[0], size[1], size[2]);
  const auto moment = [](std::uint64_t length, std::int64_t share) {
    const auto part = round_shift(
        multiply_wide(square(length), static_cast<std::uint64_t>(std::max<std::int64_t>(share, 0))),
        k_tapered_bits + 30);
    return moment_of(part.low);
  };
  const Unit across = moment(mass.length, mass.across);
  return {across, moment(mass.radius, mass.axial), across};
}

void tapered_core(const PosedShape& shape, ConvexCore& core) {
  const TaperedEnds ends = tapered_ends(shape.shape.size);
  const Fine middle = (ends.low + ends.high) / 2;
  core.radius = min(ends.low_radius, ends.high_radius);
  core.reference = along(shape.rotation.y, middle);
  if (ends.low == ends.high) return;  // a ball
  add_generator(core, along(shape.rotation.y, ends.high - middle));
  core.swell = {fine(ends.low_radius - core.radius), fine(ends.high_radius - core.radius)};
  for (int k = 0; k < 3; ++k)
    core.extent[k] += std::max(core.swell[0], core.swell[1]);
}

bool tapered_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  const Mat3 own;
  ConvexCore core;
  make_core({shape, own}, core);
  return taper_point_gap(core, fine(point)).gap.distance <= fine(core.radius + slack);
}

/// The points of both ends that reach farthest along n; of a ball one.
void tapered_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  const TaperedEnds ends = tapered_ends(shape.shape.size);
  const auto add_end = [&](Fine height, Length radius, std::uint32_t id) {
    out.add(rotate(shape.rotation, RawVec{0, height, 0}) + along(n, radius), id);
  };
  add_end(ends.low, ends.low_radius, 0);
  if (ends.high != ends.low) add_end(ends.high, ends.high_radius, 1);
}

Shape tapered_scaled(const Shape& shape, Unit share) {
  return resized(shape, scaled_sizes(shape.size, share));
}

Shape tapered_shrunk(const Shape& shape, Length depth) {
  const Length inner = tapered_inner_radius(shape);
  const Length left = inner - min(depth, inner);
  return tapered_scaled(shape, Unit::from_raw(static_cast<std::int32_t>(
                                   (std::int64_t{left.raw} << Unit::frac_bits) / inner.raw)));
}

// Rays --------------------------------------------------------------------------------------------

RimHit meet_end(const AxisRay& ray, Fine height, Length radius) {
  const RawVec centre{0, height, 0};
  const AxisRay from{ray.start - centre, ray.way};
  const RoundHit at = first_meeting(from.start, from.way, fine(radius));
  if (!at.hit) return {};
  return {true, at.fraction, ray_point(from, at.fraction)};
}

ShapeRayHit tapered_ray(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                        const Vec3<Length>& translation) {
  const AxisRay ray{to_local(rotation, origin), to_local(rotation, translation)};
  const Mat3 own;
  ConvexCore core;
  make_core({shape, own}, core);
  if (taper_point_gap(core, ray.start).gap.distance <= fine(core.radius)) return {true, {}, {}};
  const TaperedEnds ends = tapered_ends(shape.size);
  const Unit out = ends.rise(), up = ends.slope();
  const auto touched = [&](Fine height, Length radius) { return height + (up * radius).raw; };
  RimHit best;
  if (ends.low != ends.high)
    best = meet_side({out, up, ends.low, fine(ends.low_radius)}, ray,
                     {touched(ends.low, ends.low_radius), touched(ends.high, ends.high_radius)});
  take_earlier(best, meet_end(ray, ends.low, ends.low_radius));
  take_earlier(best, meet_end(ray, ends.high, ends.high_radius));
  return ray_hit(best, rotation);
}

}  // namespace

const ShapeTraits k_tapered_capsule{
    .size_names = {"bottom_radius", "height", "top_radius"},
    .size_count = 3,
    .bounding_radius = tapered_bounding_radius,
    .inner_radius = tapered_inner_radius,
    .half_extents = tapered_extents,
    .mass = tapered_mass,
    .volume = tapered_volume,
    .inertia = tapered_inertia,
    .reach = tapered_reach,
    .holds = tapered_holds,
    .face_along = round_face_along,
    .vertex_at = no_vertex_at,
    .vertices = no_vertices,
    .shrunk = tapered_shrunk,
    .shortened = tapered_scaled,
    .make_core = tapered_core,
    .below_plane = below_feature,
    .cast_ray = tapered_ray,
    .collide = collide_convex,
    .find_feature = tapered_feature,
    .with_round_ends = nullptr,
};

}  // namespace geometry

Shape Shape::tapered_capsule(Length height, Length bottom_radius, Length top_radius) {
  return {ShapeKind::tapered_capsule, {bottom_radius, height, top_radius}, {}};
}

}  // namespace lockstone
