// Builds the islands of a tick from its contacts and joints, and counts the work of each.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/dynamics/islands/tick_islands.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/pinched_islands.h"

namespace lockstone {

class IslandBuilder {
 public:
  /// No function but this allocates.
  [[gnu::cold]] IslandBuilder(std::size_t body_capacity, std::size_t contact_capacity);

  /// Once all bodies have their numbers: joins bodies by contacts and joints, counts contacts, and
  /// marks pinched islands.
  void build(const ContactScene& scene, const SolverBodies& bodies, const ContactList& contacts);

  /// Marks the islands that restitution may give energy, and those that moving surfaces and drives
  /// may; once a tick, however often it is called.
  void find_energy_sources(const ContactScene& scene, const SolverBodies& bodies,
                           const ContactList& contacts);

  /// Once it is known which islands are converged.
  void find_stacks() { has_stacks_ = islands_.any(&IslandTally::is_stack); }
  [[nodiscard]] bool has_stacks() const { return has_stacks_; }

  [[nodiscard]] const TickIslands& all() const { return islands_; }
  /// Islands, with 0, which is none.
  [[nodiscard]] std::uint32_t count() const { return islands_.count(); }
  /// The island of a body; 0 of one that is not dynamic.
  [[nodiscard]] std::uint32_t of(BodyRef body) const {
    return body.is_standing() ? 0 : islands_.of(body.number());
  }
  /// A contact has at least one dynamic body, and all of its dynamic bodies are of one island.
  [[nodiscard]] std::uint32_t of(const ContactRef& contact) const {
    const std::uint32_t a = of(contact.a), b = of(contact.b);
    LKS_ASSERT(a != 0 || b != 0);
    LKS_ASSERT(a == 0 || b == 0 || a == b);
    return std::max(a, b);
  }
  /// The island of a joint, which has at least one dynamic body.
  [[nodiscard]] std::uint32_t of(const ContactScene& scene, const SolverBodies& bodies,
                                 const JointLink& link) const;

  /// The island of a body by its index in the world; null of one that is in none.
  [[nodiscard]] const IslandTally* find(const SolverBodies& bodies, std::uint32_t body) const {
    const std::uint32_t number = bodies.number_of(body);
    const std::uint32_t island = number == 0 ? 0 : islands_.of(number);
    return island == 0 ? nullptr : &tally(island);
  }

  [[nodiscard]] IslandTally& tally(std::uint32_t island) { return islands_.tally(island); }
  [[nodiscard]] const IslandTally& tally(std::uint32_t island) const {
    return islands_.tally(island);
  }
  [[nodiscard]] IslandTally& tally(const ContactRef& contact) { return tally(of(contact)); }

 private:
  void join(const ContactScene& scene, const SolverBodies& bodies, const ContactList& contacts);
  void mark_pinched(const ContactScene& scene, const ContactList& contacts);
  [[nodiscard]] ImmovablePush push_of(const ContactScene& scene, const ContactRef& contact) const;

  TickIslands islands_;
  PinchedIslands pinched_;
  bool has_stacks_ = false;
  bool knows_sources_ = false;  // of energy
};

}  // namespace lockstone
