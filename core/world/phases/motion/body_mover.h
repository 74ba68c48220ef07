// Moves the bodies of a tick to its end.
#pragma once

#include <cstdint>

#include <lockstone/world.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/rest.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/motion/continuous.h"
#include "core/world/phases/motion/left_out.h"
#include "core/world/phases/motion/moved_bodies.h"

namespace lockstone {

class ContactSolver;
struct SolverBody;

/// Each awake body takes the results of the solver, of its bounces or of its pendulum; a body that
/// no constraint names takes the exact ballistic step.
class BodyMover {
 public:
  /// All outlive this.
  BodyMover(WorldData& world, MovedBodies& moved, ContactSolver& solver, LeftOut& left_out,
            ContinuousCollision& continuous, const RestRules& rest_rules)
      : world_(world),
        moved_(moved),
        solver_(solver),
        left_out_(left_out),
        continuous_(continuous),
        rest_rules_(rest_rules) {}

  void run(StepReport& report);
  /// Once continuous collision has moved bodies back: gives those that left their recycling pose
  /// another, and counts the ticks in which islands stood still.
  void end();

 private:
  struct Counts {
    std::uint32_t free_bodies = 0, axis_turns = 0, saturations = 0;
  };
  void move(std::uint32_t body, Counts& counts);
  [[nodiscard]] InverseInertia inertia_of(std::uint32_t body, const SolverBody* solved) const;

  WorldData& world_;
  MovedBodies& moved_;
  ContactSolver& solver_;
  LeftOut& left_out_;
  ContinuousCollision& continuous_;
  const RestRules& rest_rules_;
};

}  // namespace lockstone
