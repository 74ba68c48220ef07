// Decides how much the solver does for an island or a contact: every limit stands here or in
// `IslandTally`, and counts within one island.
#pragma once

#include <cstdint>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/direct/island_pool.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/input/tick_joints.h"
#include "core/dynamics/step/islands/island_builder.h"

namespace lockstone {

class EffortPolicy {
 public:
  /// `converged_contacts`: no island with more contacts and joints is solved to convergence.
  EffortPolicy(const TimeStep& step, std::size_t converged_contacts);

  /// At the beginning of a tick.
  void begin(const Vec3<Acceleration>& gravity);

  /// The mean impulse of all points of a contact from which on it is bearing, m/s, Q20: between
  /// bodies of equal mass 2½ times the impulse of gravity in a substep.
  [[nodiscard]] std::int64_t bearing_impulse() const { return bearing_impulse_; }

  /// The contacts and joints of an island that is solved to convergence, at most; 0: none is.
  [[nodiscard]] std::uint32_t most_island_contacts() const { return most_island_contacts_; }

  /// Marks islands that iterations alone can solve: those with coloured ball joints, locked axes,
  /// rolling resistance or masses of two bodies that are too uneven. Adds up how bodies move.
  static void mark_iterated(const ContactScene& scene, const SolverBodies& bodies,
                            const ContactList& contacts, const TickJoints& joints,
                            IslandBuilder& islands);

  /// Whether an island that may be loose is a loose pile: it is stirred, as more than a quarter of
  /// its bodies differ from their mean velocity by 1/4 m/s, or it was so within four seconds.
  /// Iterations bring most such piles to rest by then, at a tenth of the cost. One that still moves
  /// is jammed, and only converged contacts let it rest. Those with joints gain nothing by that,
  /// and stay loose until they sleep.
  [[nodiscard]] static bool is_loose_pile(const IslandTally& island);

  /// Counts how many bodies of an island are stirred, and marks loose piles, once the counts of
  /// islands are known.
  static void mark_stirred(const ContactScene& scene, const SolverBodies& bodies,
                           IslandBuilder& islands);

  /// The greatest n for which more than a quarter of the bodies differ from their mean velocity by
  /// more than 2^n/32 m/s along an axis, up to IslandMotion::k_levels; 0 where there is none,
  /// and of an island that is not to be solved more coarsely when it is stirred.
  [[nodiscard]] static int stir_level(const IslandTally& island);

  /// Whether an island that was solved to convergence is given up: half of the phases of the tick
  /// ended before they were solved, and factors of its size cost more than iterations do. It is
  /// iterated from the next tick on, as a loose pile.
  [[nodiscard]] bool gives_up(const IslandTally& island, const IslandView& solved) const;

  /// Whether bodies of an island stand on each other: less than a quarter of the impulses of its
  /// contacts leans. Then an initial warm start finds its loads.
  [[nodiscard]] bool stands(const IslandView& island, const ContactRun& run) const;

  /// The `loose_time` of a body of an island once it was solved: four seconds if it was stirred or
  /// is given up, in ticks or, where these are shorter, in sixtieths of a second (rounded to whole
  /// ticks); else it runs out.
  [[nodiscard]] static std::uint8_t loose_time(const IslandTally& island, const BodyRecord& body,
                                               const TimeStep& step, std::uint64_t tick);

  /// Whether an island, whose counts are known, may be solved to convergence.
  [[nodiscard]] bool may_converge(const IslandTally& island) const;

  /// Whether stacks are rebalanced in a tick.
  [[nodiscard]] static bool rebalances(std::uint64_t tick) { return tick % k_rebalance_ticks == 0; }

  /// Whether a body of a stack hardly moves: it may stand on rigid contacts.
  [[nodiscard]] static bool rests(const lanes::BodyVelocity& row, const SolverBody& body);

  /// Whether a contact of a stack bears, and lies where it comes to rest: it is rigid, since a
  /// stack would bend by a spring there. Other contacts stay springs, since a spring damps a body
  /// that rattles.
  [[nodiscard]] bool is_rigid(const ContactScene& scene, const SolverBodies& bodies,
                              const ContactRef& contact) const;

  /// Whether the lighter body, at rest, gains more from the contact than gravity and forces give
  /// it; or has just been put there, so that nobody knows yet. `share_b`: B's part of the pair's
  /// inverse mass, Q30.
  [[nodiscard]] static bool is_overloaded(const ContactScene& scene, const SolverBodies& bodies,
                                          const ContactRef& contact, std::int64_t share_b);

 private:
  [[nodiscard]] static bool is_stirred(const IslandTally& island);

  // From one rebalance of a stack to the next.
  static constexpr std::uint64_t k_rebalance_ticks = 16;

  TimeStep step_;
  std::uint32_t most_island_contacts_;
  std::int64_t bearing_impulse_ = 0;
  Vec3<Acceleration> gravity_{};
};

}  // namespace lockstone
