#include "core/collision/broad_phase.h"

#include <algorithm>

namespace lockstone {
namespace {

// How far a moving body may go before its leaf is put anew.
constexpr BoundsCoordinate k_fat_margin = BoundsCoordinate::from_ratio(1, 8);

}  // namespace

BroadPhase::BroadPhase(std::uint32_t body_capacity, std::uint32_t pair_capacity)
    : static_tree_(body_capacity),
      moving_tree_(body_capacity),
      proxies_(body_capacity),
      pair_capacity_(pair_capacity) {
  partners_.reserve(body_capacity);
  pairs_.reserve(pair_capacity);
}

void BroadPhase::clear() {
  static_tree_.clear();
  moving_tree_.clear();
  std::fill(proxies_.begin(), proxies_.end(), Proxy{});
}

void BroadPhase::set_bounds(std::uint32_t body, const Bounds& bounds, bool moves) {
  Proxy& proxy = proxies_[body];
  proxy.bounds = bounds;
  if (proxy.leaf != k_absent && proxy.moves == moves &&
      contains(tree(moves).bounds(proxy.leaf), bounds)) {
    return;
  }
  if (proxy.leaf != k_absent) tree(proxy.moves).remove(proxy.leaf);
  proxy.moves = moves;
  proxy.leaf = tree(moves).insert(moves ? inflated(bounds, k_fat_margin) : bounds, body);
}

void BroadPhase::remove(std::uint32_t body) {
  Proxy& proxy = proxies_[body];
  if (proxy.leaf == k_absent) return;
  tree(proxy.moves).remove(proxy.leaf);
  proxy = Proxy{};
}

void BroadPhase::append_sorted(std::uint32_t body) {
  std::sort(partners_.begin(), partners_.end());
  for (const std::uint32_t other : partners_) {
    if (pairs_.size() == pair_capacity_) {
      overflowed_ = true;
      return;
    }
    pairs_.push_back({body, other});
  }
}

}  // namespace lockstone
