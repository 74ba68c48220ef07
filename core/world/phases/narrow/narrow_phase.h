// The narrow phase of a tick: finds the contacts of the pairs that the broad phase found, and
// numbers them in the order of the pairs.
#pragma once

#include <cstdint>
#include <span>

#include <lockstone/world.h>

#include "core/world/phases/narrow/narrow_data.h"

namespace lockstone {

class NarrowPhase {
 public:
  /// No functions but this and `make_room` allocate. Both outlive this.
  NarrowPhase(WorldData& world, TickContacts& found);
  /// Makes room for as many workers as there are.
  void make_room();

  /// Fills the contacts of the tick.
  void run(std::span<const Pair> pairs, StepReport& report);

  /// How far ahead a pair looks for contacts.
  [[nodiscard]] Length margin_of(const Pair& pair) const;
  /// Whether the two would get a contact now.
  [[nodiscard]] bool meet(const Pair& pair);

  /// Whether the two pass each other in this tick, one of them one-way.
  [[nodiscard]] bool are_passing(std::uint32_t a, std::uint32_t b) const;

  /// Forgets all about the tick before.
  void forget() { data_.separating_axes.forget(); }

  /// Contacts that the last run found, those included that were dropped again.
  [[nodiscard]] std::uint32_t found_at_first() const { return data_.ids.taken_at_first(); }

  /// Scratch that other phases may use between runs.
  [[nodiscard]] PairScratch& scratch() { return data_.ids.scratch(0); }
  /// Whether shapes with triangles exist.
  [[nodiscard]] bool knows_triangles() { return scratch().triangles != nullptr; }

 private:
  void find_turning_speeds();
  [[nodiscard]] bool collide_side_by_side();
  void collide_one_by_one();
  void collide_piece(std::uint32_t first, std::uint32_t end, PairScratch& scratch);
  [[nodiscard]] bool look_for_seam(std::uint32_t pair, bool beside_static);
  void number_contacts(StepReport& report);
  void number_contacts_of(std::uint32_t pair);

  NarrowData data_;
};

/// As far as a pair can close in one tick, but no farther than the bodies are thick, or a glancing
/// pass would be taken for a hit.
[[nodiscard]] Length margin_of(const WorldData& world, const Pair& pair);
/// `turning`: the sum of both `turning_speed`.
[[nodiscard]] Length margin_of(const WorldData& world, const Pair& pair, std::int64_t turning);

/// Removes the ghosts at the seams between static bodies (seams.cpp).
void remove_seams(NarrowData& data);

}  // namespace lockstone
