// Springs, motors and limits of joints: solved row by row, joint by joint.
//
// All functions below read and write the impulses of one joint, and push its bodies.
#pragma once

#include <cstdint>

#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/dynamics/linkage/system/linked_joint.h"
#include "core/dynamics/state/time_step.h"

namespace lockstone {

/// Sets the bounds of a joint's motors and the parts of its springs, from its masses and from the
/// joints of its bodies.
void set_drives(const JointSystem& system, LinkedJoint& joint);

/// At a tick's beginning: limits that cannot be reached in it push nothing and need no rows.
void leave_out_far_limits(const JointRun& run, const TimeStep& step, LinkedJoint& joint);

/// Before positions move: springs, and with `motors` also those. Returns whether any impulse
/// changed.
bool solve_drives(const JointRun& run, LinkedJoint& joint, bool motors);

/// After positions moved: the second part of springs.
void solve_springs_later(const JointRun& run, LinkedJoint& joint);

/// Limits, before positions move and after it. Returns whether any impulse changed.
bool solve_limits(const JointRun& run, const TimeStep& step, LinkedJoint& joint, bool positions);

/// The speed at which the rest of the way to a limit may be gone, or, before positions move, at
/// which it is pushed back; Q50.
[[nodiscard]] std::int64_t limit_speed(const TimeStep& step, const JointRow& row, bool positions);

}  // namespace lockstone
