// Functions that the solids of revolution share.
#pragma once

#include "core/geometry/contact/feature/contact_feature.h"
#include "core/geometry/contact/half_space/plane_meeting.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/query/ray_hit.h"

namespace lockstone::geometry {

/// π, 61 fraction bits.
inline constexpr std::uint64_t k_pi = 7244019458077122842U;

/// A disc across the y axis, at `height`.
struct Disc {
  Fine height = 0;
  Length radius{};
};

/// Ids of a disc's points: 16 that stand still on it, and the one that reaches farthest.
inline constexpr std::uint32_t k_disc_points = 16;
inline constexpr std::uint32_t k_disc_deepest = k_disc_points;
inline constexpr std::uint32_t k_second_disc = 32;

/// Adds the disc's polygon: 16 points, and the one farthest along n unless the disc leans by less
/// than 2^-12 rad and over its radius by less than 2^-13 m, each along x and z. There those 16
/// reach as far within 2^-13 m · √2 · (1 − cos π/16) = 3.4 µm. `sign` is that of the disc's outward
/// normal along y.
void add_disc(const PosedShape& shape, const Disc& disc, int sign, const Vec3<Unit>& n,
              std::uint32_t first_id, ContactFeature& out);

/// The point of a disc's rim that is farthest along n, world axes; the disc's normal is not n.
[[nodiscard]] RawVec deepest_of(const PosedShape& shape, const Disc& disc, const Vec3<Unit>& n);

/// r · |(x, z)|, fine: how far a rim reaches along a vector.
[[nodiscard]] Fine rim_reach(Length radius, Unit x, Unit z);

/// √(x² + z²), rounded down.
[[nodiscard]] Length distance_from_axis(const Vec3<Length>& point);

/// Their cores have no vertices that contacts name by number.
[[nodiscard]] std::optional<std::uint32_t> no_vertex_at(const Shape& shape, const RawVec& point);
[[nodiscard]] int no_vertices(const Shape& shape, std::array<RawVec, 8>& out);

/// The points of a shape's feature below a plane.
[[nodiscard]] Manifold below_feature(const PlaneMeeting& plane);

// Rays, in the shape's own axes, fine -------------------------------------------------------------

struct AxisRay {
  RawVec start;
  RawVec way;
};

/// A point of entry.
struct RimHit {
  bool hit = false;
  std::int64_t fraction = 0;  ///< 60 fraction bits
  RawVec outward{};           ///< of any length, the shape's axes
};

void take_earlier(RimHit& best, const RimHit& other);

/// start + fraction · way.
[[nodiscard]] RawVec ray_point(const AxisRay& ray, std::int64_t fraction);

/// Where a ray enters through a disc, whose outward normal is y or −y.
[[nodiscard]] RimHit meet_disc(const AxisRay& ray, const Disc& disc, int sign);

[[nodiscard]] ShapeRayHit ray_hit(const RimHit& hit, const Mat3& rotation);

}  // namespace lockstone::geometry
