// The bodies that move in a tick, and where they were before.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/transform.h>

#include "core/world/data/world_data.h"

namespace lockstone {

class MovedBodies {
 public:
  /// No function but this allocates. `world` outlives this.
  explicit MovedBodies(WorldData& world);

  /// Begins a tick: lists all awake bodies.
  void list_awake();
  /// Begins another list, body by body, ascending.
  void clear() { bodies_.clear(); }
  void add(std::uint32_t body) { bodies_.push_back(body); }

  /// Ascending.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }
  /// Pieces of `bodies()` that are worth a worker each.
  [[nodiscard]] Loop pieces() const;

  /// Where a listed body was before it moved; to be noted before it does.
  [[nodiscard]] const Transform& start(std::uint32_t body) const { return starts_[body]; }
  void note_start(std::uint32_t body) {
    starts_[body] = {world_.bodies[body].position, world_.bodies[body].orientation};
  }

  /// Derives rotations, bounds and places in the broad phase of the listed bodies again.
  void refresh();

 private:
  void refresh_piece(std::uint32_t first, std::uint32_t end, std::atomic<bool>& changed);

  WorldData& world_;
  std::vector<std::uint32_t> bodies_;
  std::vector<Transform> starts_;             // by body
  std::vector<std::uint8_t> leaves_fat_box_;  // by place in `bodies_`
};

}  // namespace lockstone
