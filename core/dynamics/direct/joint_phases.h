// The joints among an island's contacts. Locks are rows that may pull, limits are rows that push;
// both are read again in each phase, where the joint solver has them. Their impulses go to the
// joint solver, which repeats those of locks in the next substep, and a phase finds their changes.
// Springs and motors act in between, one by one; then the joint solver closes the openings that
// second-order terms leave.
#pragma once

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/direct/island_pool.h"
#include "core/dynamics/linkage/island_joints.h"

namespace lockstone {

/// The joints of a tick, and the data that they are solved with.
struct JointAccess {
  IslandJoints& joints;
  JointRun run;
};

namespace joint_phases {

/// Before a phase: joints have pushed the bodies since the last one, and turn with them. Rows and
/// factor are kept while no joint's rows have turned far. Bodies of number `first_free` or above
/// touch nothing.
void update(const ContactRun& run, const JointAccess& access, const IslandView& island,
            std::uint32_t first_free, bool pushes_out);

/// After a phase: gives its impulses to the joint solver.
void give(const JointAccess& access, const IslandView& island);

}  // namespace joint_phases

}  // namespace lockstone
