// Starts islands warm: propagates loads down new stacks, rebalances old ones from time to time, and
// limits the energy of all that are iterated.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/parallel.h"
#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/stack/initial_warm_start.h"
#include "core/dynamics/stack/stack_rebalance.h"
#include "core/dynamics/step/contacts/constraint_layout.h"
#include "core/dynamics/step/contacts/iterated_gain_limit.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/input/tick_joints.h"
#include "core/dynamics/step/islands/island_builder.h"

namespace lockstone {

class StackWarmStart {
 public:
  /// The other parts of the tick, which must outlive this.
  struct Parts {
    SolverBodies& bodies;
    const ContactList& contacts;
    IslandBuilder& islands;
    const TickJoints& joints;
    const ConstraintLayout& layout;
    int substeps;
  };

  /// No functions but this and `make_room` allocate.
  [[gnu::cold]] StackWarmStart(std::size_t body_capacity, std::size_t contact_capacity,
                               std::size_t joint_capacity, const Parts& parts);
  void make_room(std::uint32_t workers);

  /// Once blocks are prepared and counts of overloaded contacts are known, before converged islands
  /// begin: they take the impulses of blocks, and scale the velocities that these give themselves.
  void find(const ContactScene& scene, const ContactRun& run, Parallel& parallel);

  /// Limits the energy that impulses have given since a substep's beginning.
  [[nodiscard]] IteratedGainLimit& gain_limit() { return limit_; }

  /// Writes the mean impulses of new iterated contacts that `find` gave one.
  void store(std::span<ContactRecord> records) const { initial_.store(supports_, records); }

 private:
  template <class Takes>
  void add_supports(const ContactScene& scene, const Takes& takes);
  [[nodiscard]] bool is_free(BodyRef body) const;

  Parts parts_;
  SupportGraph supports_;
  InitialWarmStart initial_;
  StackRebalance rebalance_;
  IteratedGainLimit limit_;
};

}  // namespace lockstone
