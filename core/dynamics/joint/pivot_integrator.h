// A body that hangs on one point of something that stands still, and touches nothing: a pendulum or
// a top. It turns about that point, so that the joint holds by itself and nothing is iterated.
//
// About the point the body has a tensor of inertia and an angular momentum of its own; gravity and
// forces are a torque that depends on the orientation alone. A step is a sixth of the torque, half
// of a free turn (free_rotation.h), two thirds of the torque with a part of its gradient along
// itself, half of a free turn, a sixth of the torque: of fourth order, and symplectic. The scheme
// is 4A of S. A. Chin, "Symplectic integrators from composite operator factorizations", 1997. With
// τ the torque, W the inverse inertia, G = τ·Wτ, the middle torque is τ + h²/48·∇G.
#pragma once

#include <cstdint>

#include <lockstone/vec3.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/time_step.h"

namespace lockstone {

/// Where a body hangs: in the world, and in its own frame of mass.
struct Pivot {
  Vec3<Position> place{};
  Vec3<Length> anchor{};
};

/// The result of a tick.
struct PivotStep {
  Vec3<Velocity> impulse{};  // of the pivot per mass, the mean of the substeps
  std::uint32_t axis_turns = 0;
};

/// Whether `step_about_pivot` may take a dynamic body without locked axes: the joint holds within
/// 2^-16 m, the arm is no more than some 30 times the body's radius, and the step resolves the
/// swing.
[[nodiscard]] bool can_step_about_pivot(const BodyRecord& body, const Mat3& rotation,
                                        const Pivot& pivot, const Vec3<Acceleration>& gravity,
                                        const TimeStep& step);

/// Moves the body by a tick. Only the part of its velocities that turns it about the pivot counts;
/// the angular momentum about the pivot is kept to 2^-32 m/s of the arm's end.
PivotStep step_about_pivot(BodyRecord& body, const Mat3& rotation, const Pivot& pivot,
                           const Vec3<Acceleration>& gravity, const TimeStep& step);

}  // namespace lockstone
