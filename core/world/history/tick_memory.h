// A tick that was stepped, as a history remembers it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/event.h>
#include <lockstone/joint.h>

#include "core/base/pool_use.h"
#include "core/collision/broad_phase/pair.h"
#include "core/dynamics/direct/pool_share.h"
#include "core/world/data/world_data.h"
#include "core/world/state/delta.h"
#include "core/world/state/stores.h"

namespace lockstone {

/// A state in memory, in the form of a native snapshot.
class StateCopy {
 public:
  /// No function but this allocates. Pages that no state needs are never touched.
  explicit StateCopy(std::size_t capacity) : bytes_(new std::byte[capacity]), capacity_(capacity) {}

  void save(const WorldData& world) {
    size_ = write_native<WorldStores>(world, out());
    LKS_CHECK(size_ != 0);
  }
  /// To be filled from the front; `set_size` follows.
  [[nodiscard]] std::span<std::byte> out() { return {bytes_.get(), capacity_}; }
  void set_size(std::size_t size) { size_ = size; }

  [[nodiscard]] ByteView bytes() const { return {bytes_.get(), size_}; }
  [[nodiscard]] NativeState<WorldStores> open(const WorldDef& def) const {
    const Result<NativeState<WorldStores>> state = NativeState<WorldStores>::open(bytes(), def);
    LKS_CHECK(state.ok());
    return state.value();
  }

 private:
  std::unique_ptr<std::byte[]> bytes_;
  std::size_t capacity_;
  std::size_t size_ = 0;
};

struct TickMemory {
  /// No function but this allocates.
  explicit TickMemory(const WorldDef& def);
  [[nodiscard]] static std::size_t bytes_max(const WorldDef& def);

  std::uint64_t tick = 0;  // its number: the ticks stepped before
  bool is_known = false;   // else the rest says nothing
  StateCopy before;        // once the tick's commands were applied
  StateCopy after;
  std::vector<ContactEvent> events;
  std::vector<HitEvent> hit_events;
  std::vector<JointEvent> joint_events;
  std::vector<Pair> pairs;             // whose bounds overlapped
  std::vector<std::uint32_t> groups;   // by body: the least body of its group (island_groups.h)
  std::vector<std::uint32_t> lookers;  // bodies whose paths were held against others
  std::vector<IslandShare> shares;     // of converged islands in their pools
  PoolUse pools;                       // of the whole tick in all other pools, at most
  std::uint32_t islands = 0;           // groups with an awake body
  bool had_sleepers = false;           // when it began
};

/// Whether a record has the bytes of the one of that index in a state.
template <class Store>
[[nodiscard]] bool is_same(const typename Store::Record& record,
                           const NativeState<WorldStores>& state, std::uint32_t index) {
  const ByteView all = state.records.bytes_of<Store>();
  return std::memcmp(&record, all.data() + index * sizeof(record), sizeof(record)) == 0;
}

/// Whether a difference of a body may reach the bodies that it meets, and theirs reach it: of all
/// that can move in a tick. The motion of a kinematic body depends, in its last bits, on whether it
/// touches anything.
[[nodiscard]] inline bool links_others(const BodyRecord& body) {
  return body.is_dynamic() || body.is_awake();
}

}  // namespace lockstone
