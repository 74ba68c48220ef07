// How the rows of joints read the velocities of bodies, and how their impulses change them.
//
// A row with the Jacobian (J, G) sees the speed J·v + G·M·L of each body, with its velocity v, spin
// L and inverse inertia M; G·M is the row's response. The row's impulse P, a velocity jump of the
// pair, changes the body by ΔL = share·Gᵀ·P and Δv = share·Jᵀ·P with the body's share of the pair's
// inverse mass.
#pragma once

#include <cstdint>
#include <span>

#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/dynamics/linkage/system/linked_joint.h"

namespace lockstone {

/// The relative velocity that a row of the joint sees, of a lock less the speed with which it
/// turns; Q50, within ±k_row_bound.
[[nodiscard]] std::int64_t row_speed(const JointRun& run, const LinkedJoint& joint,
                                     const JointRow& row);

/// Applies the impulse of one row.
void push(const JointRun& run, const LinkedJoint& joint, std::size_t row, std::int64_t impulse);

/// Applies the impulses of rows first … end − 1; others are not read.
void push(const JointRun& run, const LinkedJoint& joint, std::size_t first, std::size_t end,
          const RowImpulses& impulses);

// The changes of velocity by joints in a stage are also added to the velocities at the substep's
// beginning: else the next substep would take them for impulses of contacts, and repeat them.

/// Notes the velocities that a stage begins with.
void begin_pushes(const JointRun& run, JointSystem& system, std::span<const std::uint32_t> bodies);
/// Adds the changes since then to `run.before`.
void end_pushes(const JointRun& run, const JointSystem& system,
                std::span<const std::uint32_t> bodies);

}  // namespace lockstone
