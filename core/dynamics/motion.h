// How bodies move within a tick.
#pragma once

#include "core/dynamics/body_record.h"
#include "core/dynamics/inertia.h"
#include "core/dynamics/solver_body.h"
#include "core/dynamics/time_step.h"

namespace lockstone {

/// Scales velocity and spin by 1 / (1 + damping·dt).
void apply_damping(BodyRecord& body, const TimeStep& step);

/// Clamps the speed and the surface speed to the speed limit. Answers whether it had to.
bool limit_speed(BodyRecord& body, const InverseInertia& inertia);

/// Clamps the position to the world, stopping what would leave it. Answers whether it had to.
bool limit_position(BodyRecord& body);

/// The exact step of a body that nothing touches, and of a kinematic one. In flight
/// x ← x + v·dt + g·dt²/2 and spin is constant; the orientation takes a midpoint step, of second
/// order.
///
/// What a value per second gives in one tick is rounded so that `tick_rate` ticks in a row, counted
/// from `tick`, add up to exactly one second's worth: drift and free fall lose nothing.
void fly(BodyRecord& body, const Mat3& rotation, const Vec3<Acceleration>& gravity,
         const TimeStep& step, std::uint64_t tick);

/// What gravity adds to a body's velocity in a fraction of a tick.
[[nodiscard]] Vec3<Velocity> gravity_gain(const BodyRecord& body, const Vec3<Acceleration>& gravity,
                                          const TimeStep& step, Unit fraction);

/// Starts a body's substeps.
[[nodiscard]] SolverBody begin_substeps(const BodyRecord& body, const Mat3& rotation,
                                        const Vec3<Acceleration>& gravity, const TimeStep& step);

void integrate_velocity(SolverBody& body);
void integrate_position(SolverBody& body, const TimeStep& step);

/// Writes a body's substeps back.
void end_substeps(BodyRecord& body, const SolverBody& solved);

}  // namespace lockstone
