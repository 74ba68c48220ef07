// The contacts of the state, in two lists: those with an awake body, which ticks read and replace,
// and those between sleeping bodies, which are set aside.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

#include "core/dynamics/state/contact_record.h"
#include "core/world/state/sleeping_contacts.h"

namespace lockstone {

/// Each active contact has the id of the manifold that the last tick found for it, as long as
/// manifolds are remembered. Ids are derived data: nothing but the time of a tick depends on them.
class ContactLists {
 public:
  /// The id of a contact without a remembered manifold.
  static constexpr std::uint32_t k_no_manifold = 0xffffffff;

  /// No function but this allocates.
  ContactLists(std::uint32_t body_capacity, std::uint32_t contact_capacity);

  /// Contacts with an awake body, by key.
  [[nodiscard]] std::span<const ContactRecord> active() const { return {store_.data(), active_}; }
  [[nodiscard]] const SleepingContacts& sleeping() const { return sleeping_; }
  /// Active and sleeping ones.
  [[nodiscard]] std::uint32_t count() const { return active_ + sleeping_.count(); }
  /// The number of active contacts that fit beside the sleeping ones.
  [[nodiscard]] std::uint32_t active_capacity() const {
    return static_cast<std::uint32_t>(store_.size()) - sleeping_.count();
  }

  /// The place of an active contact in `active()`.
  [[nodiscard]] std::uint32_t index_of(const ContactRecord& record) const {
    LKS_ASSERT(is_active(record));
    return static_cast<std::uint32_t>(&record - store_.data());
  }

  /// Calls `visit(record)` for every contact there is, by key. No body of a contact has an index of
  /// `body_limit` or more.
  template <class Visit>
  void for_each(std::uint32_t body_limit, Visit&& visit) const {
    std::span<const ContactRecord> ahead = active();
    sleeping_.for_each(body_limit, [&](const ContactRecord& record) {
      for (; !ahead.empty() && ahead.front().key() < record.key(); ahead = ahead.subspan(1))
        visit(ahead.front());
      visit(record);
    });
    for (const ContactRecord& record : ahead)
      visit(record);
  }

  [[nodiscard]] bool remembers_manifolds() const { return remembers_manifolds_; }
  void forget_manifolds() { remembers_manifolds_ = false; }
  /// Of the active contacts of a body.
  void forget_manifolds_of(std::uint32_t body);
  /// By active contact, while manifolds are remembered.
  [[nodiscard]] std::span<const std::uint32_t> manifold_ids() const { return manifold_ids_; }

  /// Writes new active contacts from place `first` on; `replace` makes them the list.
  void write(std::uint32_t first, std::span<const ContactRecord> records) {
    std::copy(records.begin(), records.end(), store_.begin() + first);
  }
  /// The first `ids.size()` written contacts become the active ones. Swaps their ids in.
  void replace(std::vector<std::uint32_t>& ids);

  /// Drops the active contacts for which `keeps(record)` is false.
  template <class Keeps>
  void keep_active(Keeps&& keeps) {
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < active_; ++i) {
      if (!keeps(store_[i])) continue;
      store_[kept] = store_[i];
      if (remembers_manifolds_) manifold_ids_[kept] = manifold_ids_[i];
      ++kept;
    }
    active_ = kept;
    if (remembers_manifolds_) manifold_ids_.resize(kept);
  }

  /// Drops the active contacts of a body.
  void drop_active_of(std::uint32_t body);

  /// Takes the contacts of a sleeping body out and hands each to `take(record)`.
  template <class Take>
  void thaw_all_of(std::uint32_t body, Take&& take) {
    sleeping_.remove_all_of(body, take);
  }
  /// Adds contacts, sorted by key, to the active ones. Their manifolds are not remembered.
  void merge(std::span<const ContactRecord> thawed);

  /// Sets aside the active contacts of which no body is awake. `is_awake(body)`.
  template <class IsAwake>
  void freeze(IsAwake&& is_awake) {
    for (std::size_t i = active_; i-- > 0;)
      if (!has_awake(store_[i], is_awake)) sleeping_.add(store_[i]);
    keep_active([&](const ContactRecord& record) { return has_awake(record, is_awake); });
  }

  /// Replaces both lists by the contacts of a loaded state, by key.
  template <class IsAwake>
  void adopt(std::span<const ContactRecord> all, IsAwake&& is_awake) {
    sleeping_.clear();
    const auto count = static_cast<std::uint32_t>(all.size());
    std::copy(all.begin(), all.end(), make_active(count).begin());
    freeze(is_awake);
  }
  /// Makes so many contacts active, those of a state in which nothing sleeps; to be filled.
  [[nodiscard]] std::span<ContactRecord> make_active(std::uint32_t count) {
    active_ = count;
    return {store_.data(), count};
  }
  /// Replaces the active list by those of `all` that have an awake body; the others are the
  /// sleeping ones already.
  template <class IsAwake>
  void adopt_active(std::span<const ContactRecord> all, IsAwake&& is_awake) {
    active_ = 0;
    for (const ContactRecord& contact : all)
      if (has_awake(contact, is_awake)) store_[active_++] = contact;
  }

  /// Lets `f` write a record of one of the lists.
  template <class F>
  void change(const ContactRecord& record, F&& f) {
    if (is_active(record))
      f(store_[index_of(record)]);
    else
      sleeping_.change(record, f);
  }

 private:
  template <class IsAwake>
  [[nodiscard]] static bool has_awake(const ContactRecord& contact, IsAwake&& is_awake) {
    return is_awake(contact.body_a) || is_awake(contact.body_b);
  }
  [[nodiscard]] bool is_active(const ContactRecord& record) const {
    return &record >= store_.data() && &record < store_.data() + active_;
  }

  std::vector<ContactRecord> store_;  // the first `active_` are the active ones
  std::uint32_t active_ = 0;
  SleepingContacts sleeping_;
  std::vector<std::uint32_t> manifold_ids_;  // by active contact
  bool remembers_manifolds_ = false;
};

}  // namespace lockstone
