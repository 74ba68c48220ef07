// Circles as parts of convex cores: the rims of cylinders and cones.
//
// A rim is a regular polygon of 2^15 vertices: it lies within 4.6e-9 of the radius of its circle,
// and its vertices need no list. Kept so, GJK and EPA remain exact searches in a finite set.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

inline constexpr int k_rim_bits = 15;

/// 2π in the format of an angle.
inline constexpr std::int64_t k_full_turn = 843314857;
static_assert(Angle::frac_bits == 27);

/// Up to two circles about one axis; a radius of zero makes a point. Empty when count is 0.
struct Rims {
  int count = 0;
  Vec3<Unit> u{};  ///< two axes of the planes, world
  Vec3<Unit> v{};
  std::array<RawVec, 2> centres{};  ///< fine
  std::array<Length, 2> radii{};
};

/// The vertex with this index, fine: the rim in bit 15, the step in those below.
[[nodiscard]] RawVec rim_point(const Rims& rims, int index);

/// A point at `angle` from u to v, at `radius` from the centre of a rim.
[[nodiscard]] RawVec rim_point(const Rims& rims, int rim, Angle angle, Fine radius);

/// The angle at which a rim reaches farthest along a direction of any length.
[[nodiscard]] Angle rim_angle(const Rims& rims, const RawVec& direction);

/// The vertex farthest along a direction, whose components are below 2^62; the first of equals.
/// Where several are within 2e-9 of the radius, any of these.
[[nodiscard]] int farthest_rim_vertex(const Rims& rims, const RawVec& direction);

/// The vertices of a polygon around each rim with one side at `angle`: its reach along that
/// direction is the rim's own.
inline constexpr int k_rim_sides = 32;
[[nodiscard]] RawVec around_rim(const Rims& rims, int rim, Angle angle, int side);

}  // namespace lockstone::geometry
