// The bodies that move in a tick, where they were before, and the bodies that they were held
// against on their paths.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/transform.h>

#include "core/world/data/world_data.h"

namespace lockstone {

struct BodySpeeds {
  Vec3<Velocity> velocity, spin;
};

class MovedBodies {
 public:
  /// Places for looks, of all bodies together.
  [[nodiscard]] static std::size_t most_looks(const WorldDef& def) {
    return std::size_t{4} * def.body_capacity;
  }

  /// No function but this allocates. `world` outlives this.
  explicit MovedBodies(WorldData& world);

  /// Begins a tick: lists all awake bodies but those that stand still, which are where they were.
  void list_awake(std::span<const std::uint32_t> still);
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
    const BodyRecord& record = world_.bodies[body];
    starts_[body] = {record.position, record.orientation};
    if (!start_speeds_.empty()) start_speeds_[body] = {record.velocity, record.spin};
  }
  /// Its velocities then; only of worlds with room for joints.
  [[nodiscard]] const BodySpeeds& start_speeds(std::uint32_t body) const {
    return start_speeds_[body];
  }

  /// Begins a tick's list of looks.
  void forget_looks() {
    looks_.clear();
    has_lost_looks_ = false;
  }
  /// Notes that the path of one body was held against another body that may move; against itself:
  /// that its path was examined at all. Not from two threads at once.
  void note_look(std::uint32_t body, std::uint32_t other) {
    if (!world_.bodies[other].moves()) return;
    has_lost_looks_ = has_lost_looks_ || looks_.size() == most_looks(world_.def);
    if (!has_lost_looks_) looks_.push_back({body, other});
  }
  /// First the body that looked.
  [[nodiscard]] std::span<const Pair> looks() const { return looks_; }
  /// Whether there were more looks than places for them.
  [[nodiscard]] bool has_lost_looks() const { return has_lost_looks_; }

  /// Derives rotations, bounds and places in the broad phase of the listed bodies again.
  void refresh();

 private:
  void refresh_piece(std::uint32_t first, std::uint32_t end, std::atomic<bool>& changed);

  WorldData& world_;
  std::vector<std::uint32_t> bodies_;
  std::vector<Transform> starts_;             // by body
  std::vector<BodySpeeds> start_speeds_;      // by body
  std::vector<std::uint8_t> leaves_fat_box_;  // by place in `bodies_`
  std::vector<Pair> looks_;
  bool has_lost_looks_ = false;
};

}  // namespace lockstone
