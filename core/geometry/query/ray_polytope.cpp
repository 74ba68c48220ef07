#include "core/geometry/query/ray_polytope.h"

#include "core/geometry/contact/polytope/polytope_point.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/ray_ratio.h"

namespace lockstone::geometry {
namespace {

/// The distance from its polygon that still counts as in it: 1.9 µm.
constexpr Fine k_rim = Fine{1} << (k_fine_bits - 19);

struct LocalRay {
  RawVec start;
  RawVec way;
  SplitVec split_start;
  SplitVec split_way;
};

/// The part of the ray below the planes looked at so far.
struct Passage {
  RayRatio enter{-1, 1};
  RayRatio leave{1, 1};
  int face = -1;  ///< that it enters by
  bool open = true;
};

void narrow(Passage& passage, int face, Fine height, Fine rise) {
  if (rise == 0) {
    passage.open = passage.open && height <= 0;
  } else if (rise < 0) {
    const RayRatio enter{height, -rise};
    if (passage.face >= 0 && !(passage.enter < enter)) return;
    passage.enter = enter;
    passage.face = face;
  } else {
    const RayRatio leave{-height, rise};
    if (leave < passage.leave) passage.leave = leave;
  }
}

Vec3<Unit> world_normal(const Polytope& polytope, const Mat3& rotation, int face) {
  return unit_axis(
      lockstone::rotate(rotation, polytope.faces[static_cast<std::size_t>(face)].normal));
}

ShapeRayHit cast_at_solid(const Polytope& polytope, const Mat3& rotation, const LocalRay& ray) {
  Passage passage;
  bool inside = true;
  for (std::size_t i = 0; i < polytope.faces.size(); ++i) {
    const Fine height = height_above(polytope.faces[i], ray.split_start);
    inside = inside && height <= 0;
    narrow(passage, static_cast<int>(i), height, dot(ray.split_way, polytope.faces[i].normal));
  }
  if (inside) return {true, {}, {}};
  if (!passage.open || passage.face < 0 || passage.enter.numerator < 0) return {};
  if (passage.leave < passage.enter) return {};  // `leave` starts at 1: this covers the ray's end
  return {true, rounded(passage.enter), world_normal(polytope, rotation, passage.face)};
}

/// start + ratio · way.
RawVec point_on(const LocalRay& ray, const RayRatio& ratio) {
  const UInt128 numerator{0, magnitude(ratio.numerator)};
  const auto share = static_cast<std::int64_t>(
      round_divide(numerator << 60, static_cast<std::uint64_t>(ratio.denominator)));
  const auto part = [share](std::int64_t lane) { return saturated_product(lane, share, 60); };
  return ray.start + RawVec{part(ray.way.x), part(ray.way.y), part(ray.way.z)};
}

bool is_in_polygon(const Polytope& polytope, const RawVec& point) {
  const NearestPoint at = nearest_point(polytope, point, k_rim);
  return at.found;
}

ShapeRayHit cast_at_flat(const Polytope& polytope, const Mat3& rotation, const LocalRay& ray) {
  const Fine height = height_above(polytope.faces[0], ray.split_start);
  if (magnitude_of(height) <= k_no_distance && is_in_polygon(polytope, ray.start))
    return {true, {}, {}};
  const int face = height > 0 ? 0 : 1;
  if (face == 1 && polytope.one_sided) return {};
  const PolytopeFace& plane = polytope.faces[static_cast<std::size_t>(face)];
  const Fine over = height_above(plane, ray.split_start);
  const Fine rise = dot(ray.split_way, plane.normal);
  if (over < 0 || rise >= 0 || -rise < over) return {};
  const RayRatio ratio{over, -rise};
  if (!is_in_polygon(polytope, point_on(ray, ratio))) return {};
  return {true, rounded(ratio), world_normal(polytope, rotation, face)};
}

}  // namespace

ShapeRayHit cast_ray_at_polytope(const Polytope& polytope, const Mat3& rotation,
                                 const Vec3<Length>& origin, const Vec3<Length>& translation) {
  const RawVec start = to_local(rotation, origin);
  const RawVec way = to_local(rotation, translation);
  const LocalRay ray{start, way, split(start), split(way)};
  return is_flat(polytope) ? cast_at_flat(polytope, rotation, ray)
                           : cast_at_solid(polytope, rotation, ray);
}

}  // namespace lockstone::geometry
