// When two moving and turning convex shapes come near each other.
#pragma once

#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/distance/motion/separating_motion.h"

namespace lockstone {

/// The placement at a fraction in [0, 1].
[[nodiscard]] Transform pose_at(const Sweep& sweep, Unit fraction);

/// Where a pose goes that is fixed to the body in motion.
[[nodiscard]] Transform carried(const Transform& pose, const Sweep& by);

/// A convex shape on a body in motion; the shape's axes are the body's.
struct SweptShape {
  const Shape& shape;
  const Sweep& sweep;
  const geometry::Polytope* polytope = nullptr;
  Vec3<Length> origin{};  ///< of the shape's frame, from the centre of rotation, body axes
};

struct TimeOfImpactLimits {
  Length target = Length::from_ratio(1, 2000);     ///< distance to stop at, m; > 0
  Length tolerance = Length::from_ratio(1, 8000);  ///< added to it, m; > 0
  int max_iterations = 64;
};

enum class TimeOfImpactState : std::uint8_t {
  separated,    ///< never as near as the target: fraction 1
  hit,          ///< the distance is between target and target + tolerance, or less at the start
  overlapping,  ///< at the start: fraction 0
  unfinished,   ///< the iterations ran out: the distance is above the target up to the fraction
};

struct TimeOfImpact {
  TimeOfImpactState state = TimeOfImpactState::separated;
  Unit fraction{};      ///< rounded down
  Vec3<Unit> normal{};  ///< from A to B, at that moment; zero when separated or the cores overlap
  Position distance{};  ///< then, m
  int iterations = 0;
};

/// The first fraction at which the distance of the shapes falls to the target. Takes the shapes of
/// `distance` but half-spaces; its bound on the offset holds all along. Before the fraction the
/// distance is not below the target by more than 3 µm and 1e-8 of the sizes, whatever the spin: no
/// step is longer than the motion can close.
///
/// Conservative advancement (Mirtich, Impulse-based dynamic simulation of rigid body
/// systems, 2.3.2) on the closest points' plane, with `geometry::safe_step` for the steps.
[[nodiscard]] TimeOfImpact time_of_impact(const SweptShape& a, const SweptShape& b,
                                          const TimeOfImpactLimits& limits = {});

}  // namespace lockstone
