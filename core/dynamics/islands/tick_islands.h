// The islands of a tick: dynamic bodies that contacts or joints connect, and the solver's work for
// each. Every budget of the solver counts within one island, so that the motion of an island does
// not depend on others (law 9, docs/explanation/locality.md).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <lockstone/assert.h>

namespace lockstone {

/// A count that several threads raise, and that is copied while none does.
class SharedCount {
 public:
  SharedCount(std::uint32_t count = 0) : count_(count) {}
  SharedCount(const SharedCount& other) : count_(other.get()) {}
  SharedCount& operator=(const SharedCount& other) {
    count_.store(other.get(), std::memory_order_relaxed);
    return *this;
  }

  [[nodiscard]] std::uint32_t get() const { return count_.load(std::memory_order_relaxed); }
  void raise() { count_.fetch_add(1, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint32_t> count_;
};

/// How one body of an island moved in a tick.
struct BodyMotion {
  bool has_moved = false;      ///< its pose has changed
  bool has_travelled = false;  ///< by more than the solver's errors
  bool is_settled = true;      ///< it is left with no more velocity than rounding gives
};

/// How the bodies of an island move.
struct IslandMotion {
  /// By how much bodies may differ from the mean velocity, in powers of two.
  static constexpr std::size_t k_levels = 6;

  std::int32_t velocity[3]{};                     ///< the mean of its bodies, 1/16 m/s
  bool is_fast = false;                           ///< a body is faster than 1/16 m/s along an axis
  std::array<std::uint32_t, k_levels> stirred{};  ///< bodies of level n + 1 or above
};

/// Counts of one island, and the solver's decisions by them.
struct IslandTally {
  /// With more overloaded contacts an island starts warm: it would settle for long otherwise.
  static constexpr std::uint32_t k_most_overloaded = 8;
  /// With more bearing contacts it is a stack, which is rebalanced: it would bend without.
  static constexpr std::uint32_t k_most_bearing = 128;
  /// With fewer bodies it is no loose pile, with joints or without: few ones converge at little
  /// cost.
  static constexpr std::uint32_t k_least_jointed_loose = 8, k_least_loose = 24;

  /// Masses of two that touch are alike up to 64 : 1, Q30.
  static constexpr std::int32_t k_least_alike = (1 << 30) / 64;

  bool iterates_only = false;     ///< nets, locked axes or rolling resistance: no direct steps
  bool is_pinched = false;        ///< between a moving kinematic body and another immovable one
  bool may_bounce = false;        ///< any restitution
  bool is_fed = false;            ///< something besides gravity and forces may give it energy
  bool has_joints = false;        ///< known where an island may gain energy
  bool is_struck = false;         ///< a contact of it comes in fast
  bool has_ball_impacts = false;  ///< `BallImpacts` may push its bodies
  bool is_carried = false;        ///< a joint holds it to an immovable body, or has a drive
  bool is_supported = false;      ///< a contact holds it against a body that is not pushed
  bool is_loose = false;          ///< a loose pile, which iterations bring to rest
  bool is_converged = false;      ///< solved to convergence, by `BlockSolver`
  bool is_given_up = false;       ///< it was converged, and is iterated for the next seconds
  std::uint32_t whole = 0;        ///< its number among those solved whole, from 1; 0: it is not
  std::uint32_t bodies = 0;       ///< dynamic ones
  std::uint32_t contacts = 0;
  std::uint32_t joints = 0;
  std::int32_t least_share = 1 << 30;  ///< of the masses of two that touch or are jointed, Q30
  std::uint32_t loose = 0;             ///< bodies whose pile stays loose, unstirred
  std::uint32_t slow = 0;              ///< bodies that hardly move, and may be held by iterations
  bool keeps_pose = false;             ///< a body turned from its recycling pose: it was iterated
  IslandMotion motion{};
  std::uint32_t fresh = 0;    ///< contacts of this tick, between two dynamic bodies
  std::uint32_t bearing = 0;  ///< contacts whose mean impulse is several times a weight
  SharedCount moved{};        ///< bodies whose poses have changed in the tick
  SharedCount travelled{};    ///< of these, bodies that did more than tremble
  SharedCount unsettled{};    ///< bodies that did not travel, and are not settled
  SharedCount strayed{};      ///< bodies beyond `wide_range` of their recycling poses
  SharedCount overloaded{};   ///< contacts at rest under several times a body's weight; from
                              ///< k_most_overloaded + 1 on it may be any greater number

  /// Enough bodies: with joints that only limit how they lie to each other, or of like masses.
  [[nodiscard]] bool may_be_loose() const {
    if (joints == 0) return bodies >= k_least_loose && least_share >= k_least_alike;
    return bodies >= k_least_jointed_loose && !is_carried && least_share >= (1 << 30) / 32;
  }
  [[nodiscard]] bool is_stack() const { return !is_converged && bearing > k_most_bearing; }
  [[nodiscard]] bool few_are_overloaded() const { return overloaded.get() <= k_most_overloaded; }
  /// Contacts are overloaded, many with joints, and a good part of all are new and have no impulses
  /// yet. Phases that begin without would let it sink before they converge.
  [[nodiscard]] bool needs_initial_warm_start() const {
    if (fresh < contacts / 4) return false;
    const bool has_no_joints = joints == 0 && bodies != 0;  // nobody counts where none converges
    if (!has_no_joints) return !few_are_overloaded() && fresh > k_most_overloaded;
    return overloaded.get() > 1 && fresh > 1;
  }
};

/// Union-find over the solver's numbers of bodies, with path halving (R. Tarjan, J. van Leeuwen,
/// "Worst-case analysis of set union algorithms", 1984).
class TickIslands {
 public:
  /// Room for this many numbers, of which this many are dynamic bodies. No function but this
  /// allocates.
  TickIslands(std::size_t row_capacity, std::size_t body_capacity);

  /// Leaves body 0 alone.
  void clear();

  /// Bodies are named 0, 1, 2, … in the order of adding. One that is not dynamic belongs to island
  /// 0, which is none.
  void add_body(bool is_dynamic) {
    parents_.push_back(is_dynamic ? static_cast<std::uint32_t>(parents_.size()) : 0);
  }

  void join(std::uint32_t a, std::uint32_t b) {
    LKS_ASSERT(a != 0 && b != 0 && a < parents_.size() && b < parents_.size());
    const std::uint32_t root_a = root(a), root_b = root(b);
    if (root_a < root_b) parents_[root_b] = root_a;
    if (root_b < root_a) parents_[root_a] = root_b;
  }

  /// After the last `join`: gives islands their numbers, in the order of their first bodies, and
  /// clears their loads.
  void settle();

  /// Islands, with the one that is none.
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(tallies_.size()); }

  /// The island of a body, after `settle`.
  [[nodiscard]] std::uint32_t of(std::uint32_t body) const {
    LKS_ASSERT(body < parents_.size());
    return parents_[body];
  }
  [[nodiscard]] IslandTally& tally(std::uint32_t island) { return tallies_[island]; }
  [[nodiscard]] const IslandTally& tally(std::uint32_t island) const { return tallies_[island]; }

  /// Whether the test holds for any island.
  template <class Test>
  [[nodiscard]] bool any(Test test) const {
    for (const IslandTally& tally : tallies_)
      if (std::invoke(test, tally)) return true;
    return false;
  }

 private:
  [[nodiscard]] std::uint32_t root(std::uint32_t body) {
    while (parents_[body] != body) {
      parents_[body] = parents_[parents_[body]];
      body = parents_[body];
    }
    return body;
  }

  std::vector<std::uint32_t> parents_;  // by body: one before it, or itself; its island in the end
  std::vector<IslandTally> tallies_;
};

}  // namespace lockstone
