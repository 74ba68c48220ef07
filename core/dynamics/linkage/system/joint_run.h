// The velocities and constants of bodies that joints read and push during a substep.
#pragma once

#include <span>

#include "core/dynamics/body/solver_body.h"
#include "core/kernels/ball/ball_block.h"
#include "core/kernels/contact/contact_rows.h"
#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

/// The data of a substep, by solver body; 0 is immovable.
struct JointRun {
  std::span<SolverBody> bodies;
  std::span<lanes::BodyVelocity> rows;
  std::span<lanes::BodyVelocity> before;  // receives joint impulses too: they are not replayed
  std::span<lanes::BodyInertia> inertias;
  std::span<lanes::BodyPlace> places;
};

}  // namespace lockstone
