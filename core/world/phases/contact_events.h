// Contact events of a tick: compares the contacts of each pair of bodies before and after it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <lockstone/event.h>

#include "core/world/data/world_data.h"
#include "core/world/phases/hit_events.h"
#include "core/world/phases/step_records.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

class ContactEvents {
 public:
  /// No function but this allocates. Both outlive this.
  ContactEvents(WorldData& world, TickContacts& found);

  /// Finds the contacts that began, ended or go on, and makes those of the tick the contacts of the
  /// state.
  void find();

  /// Of the last step. Other phases add theirs behind.
  [[nodiscard]] std::vector<ContactEvent>& list() { return events_; }
  [[nodiscard]] const std::vector<ContactEvent>& list() const { return events_; }

  [[nodiscard]] HitEvents& hits() { return hits_; }
  [[nodiscard]] const HitEvents& hits() const { return hits_; }

 private:
  PairState take_pair(std::span<const ContactRecord>& records, bool is_new) const;
  [[nodiscard]] std::optional<ContactEvent> event_of(const PairState& before,
                                                     const PairState& now) const;
  [[nodiscard]] bool asks(const Pair& pair) const;
  template <class Emit>
  void merge(std::span<const ContactRecord> before, std::span<const ContactRecord> now,
             Emit&& emit) const;
  void merge_pieces(std::uint32_t first, std::uint32_t end, bool writes);
  void add_up(bool shared);

  static constexpr std::uint32_t k_piece = 64;  // contacts of a piece of the lists

  WorldData& world_;
  TickContacts& found_;
  std::vector<ContactEvent> events_;
  HitEvents hits_;
  std::vector<std::uint32_t> piece_ends_;  // by piece: where its events end
};

}  // namespace lockstone
