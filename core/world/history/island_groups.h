// Groups of bodies that can have influenced each other in a tick: islands, taken widely.
//
// Two bodies that move are of one group if their swept bounds overlapped, if a joint connects them,
// if one was held against the path of the other, or if one woke the other. By law 9 the next state
// of a group follows from its bodies, contacts and joints, and from the bodies at rest that it
// meets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/broad_phase/pair.h"
#include "core/dynamics/islands/islands.h"
#include "core/world/data/world_data.h"
#include "core/world/history/tick_memory.h"

namespace lockstone {

class IslandGroups {
 public:
  /// No function but this allocates.
  explicit IslandGroups(std::uint32_t body_capacity);

  /// Before the tick: each body by itself, but for joints.
  void begin(const WorldData& world);

  /// Bodies that met. Those that do not move link nobody.
  void join(std::span<const Pair> pairs);
  void join(std::uint32_t a, std::uint32_t b) {
    if (links_[a] != 0 && links_[b] != 0) islands_.join(a, b);
  }

  /// Once the tick is done: joins the contacts across which bodies woke.
  void join_woken(const WorldData& world, const StateCopy& before);

  /// Writes the group of each body.
  void write(std::vector<std::uint32_t>& groups);

  /// Groups with a body that was awake, for which `counts(body)` holds; after `write`.
  template <class Counts>
  [[nodiscard]] std::uint32_t count_awake(std::span<const std::uint32_t> groups, Counts&& counts) {
    std::uint32_t count = 0;
    for (const std::uint32_t body : were_awake_) {
      std::uint8_t& is_counted = is_counted_[groups[body]];
      if (is_counted != 0 || !counts(body)) continue;
      is_counted = 1;
      ++count;
    }
    for (const std::uint32_t body : were_awake_)
      is_counted_[groups[body]] = 0;
    return count;
  }

 private:
  Islands islands_;
  std::vector<std::uint32_t> all_;         // 0, 1, 2, …
  std::vector<std::uint8_t> links_;        // by body
  std::vector<std::uint32_t> were_awake_;  // when the tick began
  std::vector<std::uint32_t> had_slept_;   // that move
  std::vector<std::uint8_t> is_counted_;   // by group
  std::uint32_t count_ = 0;                // of bodies
};

}  // namespace lockstone
