// Moves the bodies of a tick to its end.
#pragma once

#include <cstdint>

#include <lockstone/world.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/rest.h"
#include "core/dynamics/step/contact_solver.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/motion/bounces.h"
#include "core/world/phases/motion/continuous.h"
#include "core/world/phases/motion/moved_bodies.h"
#include "core/world/phases/motion/pendulums.h"

namespace lockstone {

/// Each awake body takes the results of the solver, of its bounces or of its pendulum; a body that
/// no constraint names takes the exact ballistic step.
class BodyMover {
 public:
  /// All outlive this.
  BodyMover(WorldData& world, MovedBodies& moved, ContactSolver& solver, Bounces& bounces,
            Pendulums& pendulums, ContinuousCollision& continuous, const RestRules& rest_rules)
      : world_(world),
        moved_(moved),
        solver_(solver),
        bounces_(bounces),
        pendulums_(pendulums),
        continuous_(continuous),
        rest_rules_(rest_rules) {}

  void run(StepReport& report);
  /// Gives bodies that left their recycling pose another.
  void renew_recycling_poses();

 private:
  struct Counts {
    std::uint32_t free_bodies = 0, axis_turns = 0, saturations = 0;
  };
  void move(std::uint32_t body, Counts& counts);
  [[nodiscard]] InverseInertia inertia_of(std::uint32_t body, const SolverBody* solved) const;

  WorldData& world_;
  MovedBodies& moved_;
  ContactSolver& solver_;
  Bounces& bounces_;
  Pendulums& pendulums_;
  ContinuousCollision& continuous_;
  const RestRules& rest_rules_;
};

}  // namespace lockstone
