// The bodies whose inputs of a tick differ from those that a history remembers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/world/data/world_data.h"
#include "core/world/history/tick_memory.h"

namespace lockstone {

/// Compares a world with a remembered state, record by record and byte for byte.
class StateChanges {
 public:
  /// No function but this allocates.
  explicit StateChanges(std::uint32_t body_capacity);

  void find(const WorldData& world, const NativeState<WorldStores>& before);

  /// Whether something differs that concerns all bodies, or no body that moves: tick, gravity or
  /// terrain; a contact or a joint of bodies that stand still.
  [[nodiscard]] bool concern_all() const { return concern_all_; }

  /// Whether any record differs, be it that of an empty slot.
  [[nodiscard]] bool any() const { return any_; }

  /// Bodies whose records differ, by index; also those that came or went.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }
  [[nodiscard]] bool has(std::uint32_t body) const { return is_changed_[body] != 0; }

  /// The ends of contacts and joints that differ, came or went, in no order.
  [[nodiscard]] std::span<const std::uint32_t> ends() const { return ends_; }

 private:
  void find_bodies(const WorldData& world, const NativeState<WorldStores>& before);
  void find_contacts(const WorldData& world, const NativeState<WorldStores>& before);
  void find_joints(const WorldData& world, const NativeState<WorldStores>& before);
  template <class Record>
  void add_ends(const WorldData& world, const Record& record);
  void add_end(std::uint32_t body);

  bool concern_all_ = false, any_ = false;
  std::vector<std::uint32_t> bodies_, ends_;
  std::vector<std::uint8_t> is_changed_, is_end_;  // by body
};

}  // namespace lockstone
