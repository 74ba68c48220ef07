#include "core/world/state/sleeping_contacts.h"

#include <algorithm>

#include "core/world/state/record_hash.h"

namespace lockstone {

SleepingContacts::SleepingContacts(std::uint32_t body_capacity, std::uint32_t contact_capacity)
    : nodes_(contact_capacity),
      heads_{std::vector<std::uint32_t>(body_capacity, k_null),
             std::vector<std::uint32_t>(body_capacity, k_null)} {}

void SleepingContacts::clear() {
  for (auto& heads : heads_)
    std::fill(heads.begin(), heads.end(), k_null);
  used_ = count_ = 0;
  free_ = k_null;
  hash_ = 0;
}

void SleepingContacts::link(std::uint32_t slot, int side, std::uint32_t body,
                            std::uint32_t before) {
  std::uint32_t& from = before == k_null ? heads_[side][body] : nodes_[before].links[side].after;
  const std::uint32_t after = from;
  nodes_[slot].links[side] = {before, after};
  from = slot;
  if (after != k_null) nodes_[after].links[side].before = slot;
}

void SleepingContacts::unlink(std::uint32_t slot, int side, std::uint32_t body) {
  const Link at = nodes_[slot].links[side];
  (at.before == k_null ? heads_[side][body] : nodes_[at.before].links[side].after) = at.after;
  if (at.after != k_null) nodes_[at.after].links[side].before = at.before;
}

void SleepingContacts::add(const ContactRecord& record) {
  std::uint32_t slot = free_;
  if (slot != k_null) {
    free_ = nodes_[slot].links[0].after;
  } else {
    slot = used_++;
  }
  nodes_[slot].record = record;
  const ContactKey key = record.key();
  std::uint32_t before = k_null, at = heads_[0][record.body_a];
  while (at != k_null && nodes_[at].record.key() < key) {
    before = at;
    at = next(at, 0);
  }
  link(slot, 0, record.body_a, before);
  link(slot, 1, record.body_b, k_null);
  ++count_;
  hash_ += hash_contact(record);
}

void SleepingContacts::remove(std::uint32_t slot) {
  Node& node = nodes_[slot];
  unlink(slot, 0, node.record.body_a);
  unlink(slot, 1, node.record.body_b);
  hash_ -= hash_contact(node.record);
  node.links[0].after = free_;
  free_ = slot;
  --count_;
}

}  // namespace lockstone
