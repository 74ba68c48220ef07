#include "core/world/state/contact_lists.h"

namespace lockstone {

ContactLists::ContactLists(std::uint32_t body_capacity, std::uint32_t contact_capacity)
    : store_(contact_capacity), sleeping_(body_capacity, contact_capacity) {
  manifold_ids_.reserve(contact_capacity);
}

void ContactLists::replace(std::vector<std::uint32_t>& ids) {
  LKS_ASSERT(ids.size() <= active_capacity());
  active_ = static_cast<std::uint32_t>(ids.size());
  std::swap(manifold_ids_, ids);
  remembers_manifolds_ = true;
}

void ContactLists::forget_manifolds_of(std::uint32_t body) {
  if (!remembers_manifolds_) return;
  for (std::uint32_t i = 0; i < active_; ++i)
    if (store_[i].body_a == body || store_[i].body_b == body) manifold_ids_[i] = k_no_manifold;
}

void ContactLists::drop_active_of(std::uint32_t body) {
  const std::span<ContactRecord> all(store_.data(), active_);
  const auto end = std::remove_if(all.begin(), all.end(), [&](const ContactRecord& contact) {
    return contact.body_a == body || contact.body_b == body;
  });
  const auto count = static_cast<std::uint32_t>(end - all.begin());
  remembers_manifolds_ = remembers_manifolds_ && count == active_;
  active_ = count;
}

// Both by key, from the last on.
void ContactLists::merge(std::span<const ContactRecord> thawed) {
  std::size_t from = active_;
  std::size_t to = from + thawed.size();
  LKS_ASSERT(to <= store_.size());
  active_ = static_cast<std::uint32_t>(to);
  if (remembers_manifolds_) manifold_ids_.resize(to);
  while (!thawed.empty()) {
    --to;
    const bool take_old = from > 0 && thawed.back().key() < store_[from - 1].key();
    store_[to] = take_old ? store_[from - 1] : thawed.back();
    if (remembers_manifolds_)
      manifold_ids_[to] = take_old ? manifold_ids_[from - 1] : k_no_manifold;
    if (take_old)
      --from;
    else
      thawed = thawed.first(thawed.size() - 1);
  }
}

}  // namespace lockstone
