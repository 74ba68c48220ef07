// A plane, and a shape that may reach below it.
#pragma once

#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

struct ContactFeature;

/// A plane through A's centre, and the shape B that may reach below it.
struct PlaneMeeting {
  Vec3<Unit> normal;
  const PosedShape& b;
  const Vec3<Length>& offset;
  Length margin;
  Fine centre_height;  ///< of B's centre
};

/// The points of each kind of shape: see `collide_half_space`.
[[nodiscard]] Manifold below_sphere(const PlaneMeeting& plane);
[[nodiscard]] Manifold below_capsule(const PlaneMeeting& plane);
[[nodiscard]] Manifold below_box(const PlaneMeeting& plane);
[[nodiscard]] Manifold below_points(const PlaneMeeting& plane, const ContactFeature& feature);

}  // namespace lockstone::geometry
