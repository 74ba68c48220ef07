#include "core/collision/broad_phase/tree_search.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone {
namespace {

// A tree is built again when more than this part of its leaves changes at once, or as many as it
// has were put in one by one: in closely packed scenes each insertion makes it worse.
constexpr std::uint32_t k_rebuilt_part = 4;
constexpr std::uint32_t k_least_rebuilt = 8;

// More waiting bodies than this are not searched one by one: a world of n bodies is made in
// n log n steps.
constexpr std::size_t k_most_waiting = 32;

}  // namespace

void TreeSearch::clear() {
  for (BoundingVolumeTree& tree : trees_)
    tree.clear();
  leaves_ = inserted_ = early_ = {};
  std::fill(places_.begin(), places_.end(), Place{});
  waiting_.clear();
}

void TreeSearch::put(std::uint32_t body) {
  LKS_ASSERT(body < places_.size());
  Place& place = places_[body];
  place.waits = true;
  if (place.listed) return;
  place.listed = true;
  waiting_.push_back(body);
}

void TreeSearch::remove(std::uint32_t body) {
  LKS_ASSERT(body < places_.size());
  Place& place = places_[body];
  place.waits = false;
  remove_leaf(place);
}

void TreeSearch::remove_leaf(Place& place) {
  if (place.leaf == k_null) return;
  LKS_ASSERT(leaves_[place.is_dynamic ? 1 : 0] > 0);
  trees_[place.is_dynamic ? 1 : 0].remove(place.leaf);
  --leaves_[place.is_dynamic ? 1 : 0];
  place.leaf = k_null;
}

void TreeSearch::insert(std::uint32_t body, const Proxy& proxy) {
  LKS_ASSERT(proxy.present);
  Place& place = places_[body];
  remove_leaf(place);
  place.is_dynamic = proxy.traits.is_dynamic;
  const std::size_t tree = place.is_dynamic ? 1 : 0;
  place.leaf = trees_[tree].insert(proxy.fat, layers_of(proxy.traits.filter), body);
  ++leaves_[tree];
  ++inserted_[tree];
}

void TreeSearch::refresh(std::span<const Proxy> proxies) {
  (void)put_waiting(proxies, std::exchange(early_, {}));
}

void TreeSearch::refresh_when_many(std::span<const Proxy> proxies) {
  if (waiting_.size() <= k_most_waiting) return;
  const Counts put = put_waiting(proxies, {});
  for (std::size_t i = 0; i < put.size(); ++i)
    early_[i] += put[i];
}

// Puts all waiting bodies into the trees, and returns how many into each. A tree is built again as
// if its `early` ones had waited too.
TreeSearch::Counts TreeSearch::put_waiting(std::span<const Proxy> proxies, const Counts& early) {
  Counts coming{};
  for (const std::uint32_t body : waiting_) {
    if (places_[body].waits) ++coming[proxies[body].traits.is_dynamic ? 1 : 0];
  }
  bool rebuilt[2];
  for (std::size_t i = 0; i < coming.size(); ++i) {
    const std::uint32_t before = leaves_[i] - std::min(early[i], leaves_[i]);
    const std::uint32_t fresh = coming[i] + early[i];
    LKS_ASSERT(coming[i] <= waiting_.size());
    const bool many = fresh > before / k_rebuilt_part || inserted_[i] > leaves_[i];
    rebuilt[i] = fresh + inserted_[i] > k_least_rebuilt && many;
  }
  for (const std::uint32_t body : waiting_) {
    Place& place = places_[body];
    place.listed = false;
    LKS_ASSERT(!place.waits || proxies[body].present);
    if (!place.waits) continue;
    place.waits = false;
    const bool is_dynamic = proxies[body].traits.is_dynamic;
    if (!rebuilt[is_dynamic ? 1 : 0])
      insert(body, proxies[body]);
    else if (place.is_dynamic != is_dynamic)
      remove_leaf(place);
  }
  waiting_.clear();
  for (int i = 0; i < 2; ++i) {
    if (rebuilt[i]) rebuild(i == 1, proxies);
  }
  return coming;
}

void TreeSearch::rebuild(bool dynamic, std::span<const Proxy> proxies) {
  LKS_ASSERT(waiting_.empty());
  const std::size_t index = dynamic ? 1 : 0;
  BoundingVolumeTree& tree = trees_[index];
  tree.clear();
  items_.clear();
  for (std::uint32_t body = 0; body < proxies.size(); ++body) {
    const Proxy& proxy = proxies[body];
    if (!proxy.present || proxy.traits.is_dynamic != dynamic) continue;
    items_.push_back(tree.make_leaf(proxy.fat, layers_of(proxy.traits.filter), body));
    places_[body].leaf = items_.back().leaf;
    places_[body].is_dynamic = dynamic;
  }
  leaves_[index] = static_cast<std::uint32_t>(items_.size());
  inserted_[index] = 0;
  tree.build(items_);
}

}  // namespace lockstone
