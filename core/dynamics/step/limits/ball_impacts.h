// Impacts of balls with restitution that the solver keeps, because of joints or of other contacts.
// They follow one after the other within the substep, so that a push passes along a row of balls.
// The normal of a ball's impact does not depend on how the ball turns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/contacts/contact_constraints.h"
#include "core/dynamics/step/contacts/impulse_totals.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/island_builder.h"

namespace lockstone {

class BallImpacts {
 public:
  /// The other parts of the tick, which must outlive this.
  struct Parts {
    SolverBodies& bodies;
    const ContactList& contacts;
    IslandBuilder& islands;
    ContactConstraints& constraints;
    ImpulseTotals& totals;
  };

  /// No function but this allocates.
  [[gnu::cold]] BallImpacts(const TimeStep& step, std::size_t contact_capacity, const Parts& parts);

  /// Once blocks are prepared: lists contacts of balls, in the order of the records, of islands in
  /// which anything comes in fast. Keeps the scene for the tick.
  void find(const ContactScene& scene);

  [[nodiscard]] bool empty() const { return impacts_.empty(); }

  /// Solves those that meet within the substep at hand, with these velocities by number. At its
  /// beginning these are the ones before it: contacts' impulses of the last substep, which the rows
  /// repeat then, may press a ball against another, and it must not bounce off with their speed.
  void run(std::span<const lanes::BodyVelocity> velocities);

 private:
  [[nodiscard]] bool meets(const ContactRef& contact) const;
  void respond(ContactId id);
  [[nodiscard]] BodyRecord body_now(BodyRef ref, std::uint32_t body) const;
  void push(BodyRef body, const BodyRecord& before, const BodyRecord& after);

  TimeStep step_;
  Parts parts_;
  std::vector<ContactId> impacts_;
  std::span<const lanes::BodyVelocity> velocities_;  // of the run at hand
  ContactScene scene_{};
};

}  // namespace lockstone
