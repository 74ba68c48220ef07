// Rays against round shapes: spheres, and capsules as two spheres and a cylinder.
#pragma once

#include "core/geometry/numeric/q50.h"
#include "core/geometry/query/ray_hit.h"

namespace lockstone::geometry {

/// The first f ≥ 0 with |origin + f·translation| = radius, from outside. The lanes are cut to 31
/// bits each vector by itself, which loses nothing of a sphere's ray; from there the decisions are
/// exact.
struct RoundHit {
  bool hit = false;
  std::int64_t fraction = 0;  ///< 60 fraction bits, 0 … 2^60; error < 2^-58 for the cut lanes
};
[[nodiscard]] RoundHit first_meeting(const RawVec& origin, const RawVec& translation, Fine radius);

/// Hit and miss are exact; the fraction errs by less than 2^-30.
[[nodiscard]] ShapeRayHit cast_ray_at_sphere(Length radius, const Vec3<Length>& origin,
                                             const Vec3<Length>& translation);

/// Hit and miss are exact for a capsule whose surface is off by at most 2 µm; the fraction errs by
/// the effect of that surface error and 2^-30.
[[nodiscard]] ShapeRayHit cast_ray_at_capsule(const Shape& capsule, const Mat3& rotation,
                                              const Vec3<Length>& origin,
                                              const Vec3<Length>& translation);

}  // namespace lockstone::geometry
