// The contacts between bodies of which none is awake: kept aside, so that a tick does not meet
// them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/dynamics/state/contact_record.h"
#include "core/world/state/record_hash.h"

namespace lockstone {

/// Where a contact is kept follows from the state: derived. Each body has two lists, of the
/// contacts in which it is A, by key, and of those in which it is B, in no order.
class SleepingContacts {
 public:
  /// No function but this allocates.
  SleepingContacts(std::uint32_t body_capacity, std::uint32_t contact_capacity);

  void clear();

  [[nodiscard]] std::uint32_t count() const { return count_; }

  /// Sum of the hashes of all records.
  [[nodiscard]] std::uint64_t hash() const { return hash_; }

  /// Quick for a contact that goes before all others of its body A.
  void add(const ContactRecord& record);

  /// Takes out all contacts of a body and hands each to `take(record)`, which must not change the
  /// set.
  template <class Take>
  void remove_all_of(std::uint32_t body, Take&& take) {
    for (int side = 0; side < 2; ++side) {
      while (heads_[side][body] != k_null) {
        const std::uint32_t slot = heads_[side][body];
        const ContactRecord record = nodes_[slot].record;
        remove(slot);
        take(record);
      }
    }
  }

  /// Lets `f` write a record of this set, which then stays where it is.
  template <class F>
  void change(const ContactRecord& record, F&& f) {
    const auto wanted =
        std::ranges::find_if(nodes_, [&](const Node& node) { return &node.record == &record; });
    hash_ -= hash_contact(wanted->record);
    f(wanted->record);
    hash_ += hash_contact(wanted->record);
  }

  /// Calls `visit(record)` for all contacts of a body.
  template <class Visit>
  void for_each_of(std::uint32_t body, Visit&& visit) const {
    for (int side = 0; side < 2; ++side) {
      for (std::uint32_t slot = heads_[side][body]; slot != k_null; slot = next(slot, side))
        visit(nodes_[slot].record);
    }
  }

  /// Calls `visit(record)` for all, by key. No body of a contact has an index of `body_limit` or
  /// more.
  template <class Visit>
  void for_each(std::uint32_t body_limit, Visit&& visit) const {
    if (count_ == 0) return;
    for (std::uint32_t body = 0; body < body_limit; ++body) {
      for (std::uint32_t slot = heads_[0][body]; slot != k_null; slot = next(slot, 0))
        visit(nodes_[slot].record);
    }
  }

 private:
  static constexpr std::uint32_t k_null = 0xffffffff;

  struct Link {
    std::uint32_t before = k_null;
    std::uint32_t after = k_null;  // the next free slot when this one is free
  };
  struct Node {
    ContactRecord record;
    Link links[2];  // in the list of A; in that of B
  };

  [[nodiscard]] std::uint32_t next(std::uint32_t slot, int side) const {
    return nodes_[slot].links[side].after;
  }
  void link(std::uint32_t slot, int side, std::uint32_t body, std::uint32_t before);
  void unlink(std::uint32_t slot, int side, std::uint32_t body);
  void remove(std::uint32_t slot);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> heads_[2];  // by body
  std::uint32_t used_ = 0;               // slots from here on were never taken
  std::uint32_t free_ = k_null;
  std::uint32_t count_ = 0;
  std::uint64_t hash_ = 0;
};

}  // namespace lockstone
