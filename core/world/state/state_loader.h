// Loads a state into a world. Derived data is kept where the data it follows from did not change: a
// rollback finds most bodies near where it left them.
#pragma once

#include <cstdint>
#include <span>

#include <lockstone/world.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/world/state/world_header.h"

namespace lockstone {

class StateLoader {
 public:
  explicit StateLoader(World::Impl& world) : world_(world) {}

  /// Writes the state over that of the world. `state.read<Store>(index, record)` is called once for
  /// each record, in order.
  template <class State>
  void load(const WorldHeader& header, State&& state);

  /// Loads a native snapshot.
  Status load_native(ByteView bytes);

  /// Derives everything from the records again, and forgets all notes of the last tick.
  void rebuild();

 private:
  template <class State>
  [[nodiscard]] bool take_bodies(std::uint32_t limit, State& state);
  [[nodiscard]] bool take_body(std::uint32_t body, const BodyRecord& record);
  template <class State>
  [[nodiscard]] bool take_joints(std::uint32_t limit, State& state);
  [[nodiscard]] bool none_sleeps() const;
  void take_contacts();
  void rebuild_from(std::span<const ContactRecord> contacts);
  [[nodiscard]] bool are_sleeping(std::span<const ContactRecord> all) const;

  World::Impl& world_;
};

}  // namespace lockstone
