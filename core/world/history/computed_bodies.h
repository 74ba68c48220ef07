// The bodies of a remembered tick that must be computed again; the others take their results from
// memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/broad_phase/pair.h"
#include "core/world/data/world_data.h"
#include "core/world/history/state_changes.h"
#include "core/world/history/tick_memory.h"
#include "core/world/phases/pair_filter.h"

namespace lockstone {

/// Chosen before the tick: bodies that differ from the remembered ones, those whose bounds they
/// overlap, now or then, and all of their groups. Bodies that looked along their paths in that tick
/// are always computed, since they may now find others there; so are vehicles, which look for their
/// ground.
class ComputedBodies final : public PairFilter {
 public:
  /// No function but this allocates.
  explicit ComputedBodies(const WorldDef& def);

  void choose(WorldData& world, bool has_sleepers, const TickMemory& known);

  [[nodiscard]] bool has(std::uint32_t body) const { return is_computed_[body] != 0; }
  /// Of a pair of bodies, a contact, or a joint: whether its results are computed.
  [[nodiscard]] bool has_any(std::uint32_t a, std::uint32_t b) const { return has(a) || has(b); }
  /// Nothing differs: all results are known.
  [[nodiscard]] bool are_none() const { return !all_ && count_ == 0 && !changes_.any(); }
  /// So many that it is quicker to compute all.
  [[nodiscard]] bool are_most() const { return all_ || count_ > most_; }

  /// Takes the other bodies, and their contacts, out of the tick. `bring_back` follows.
  void leave_out_others(WorldData& world);
  /// Of the others, only those that were awake are awake again; their contacts stay dropped.
  void bring_back_others(WorldData& world);

  /// The pairs of computed bodies. Keeps all of them, as long as those stay valid.
  [[nodiscard]] std::span<const Pair> take_pairs(std::span<const Pair> all) override;
  [[nodiscard]] std::span<const Pair> all_pairs() const { return all_pairs_; }

  /// Whether a tick of the computed bodies alone moved them as the whole tick would have done: it
  /// wrote no other body or joint, and no path led to a body that was left out.
  [[nodiscard]] bool kept_to_themselves(const WorldData& world, const StateCopy& before,
                                        std::span<const Pair> looks) const;

 private:
  [[nodiscard]] bool may_reach_all(WorldData& world, const TickMemory& known) const;
  void add_roots(const WorldData& world, const TickMemory& known);
  void add_sweepers(WorldData& world, const TickMemory& known);
  void add_root(std::uint32_t body, const TickMemory& known);
  void add_neighbours(const WorldData& world, std::uint32_t body, const TickMemory& known);
  void add_groups(WorldData& world, const TickMemory& known);

  StateChanges changes_;
  bool all_ = false;
  std::uint32_t count_ = 0;                // of computed bodies
  std::uint32_t most_ = 0;                 // with more all are computed
  std::vector<std::uint8_t> is_computed_;  // by body
  std::vector<std::uint8_t> is_reached_;   // by group of the remembered tick
  std::vector<std::uint32_t> left_out_;    // awake bodies
  std::vector<Pair> pairs_;
  std::span<const Pair> all_pairs_;
};

}  // namespace lockstone
