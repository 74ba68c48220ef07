// Finds the pairs of bodies whose bounds overlap.
//
// The pair set is a function of the tight bounds alone. Trees hold fattened boxes only so that a
// body that moves a little need not be moved in its tree.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/collision/bounding_volume_tree.h"
#include "core/collision/bounds.h"

namespace lockstone {

/// Two bodies whose bounds overlap. `a` can move; `b` is static, or can move and has the higher
/// index.
struct Pair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;

  friend constexpr auto operator<=>(const Pair&, const Pair&) = default;
};

class BroadPhase {
 public:
  BroadPhase(std::uint32_t body_capacity, std::uint32_t pair_capacity);

  /// Forgets all bodies.
  void clear();

  /// Sets a body's tight bounds, adding the body if it is new. `moves`: kinematic or dynamic.
  void set_bounds(std::uint32_t body, const Bounds& bounds, bool moves);
  void remove(std::uint32_t body);

  [[nodiscard]] bool has(std::uint32_t body) const { return proxies_[body].leaf != k_absent; }
  [[nodiscard]] const Bounds& bounds(std::uint32_t body) const { return proxies_[body].bounds; }

  /// All overlapping pairs of bodies below `body_limit` for which `accept(a, b)` holds, sorted.
  /// When they exceed the capacity, the first ones in that order, and `overflowed` is true.
  template <class Accept>
  std::span<const Pair> find_pairs(std::uint32_t body_limit, Accept&& accept) {
    pairs_.clear();
    overflowed_ = false;
    for (std::uint32_t body = 0; body < body_limit && !overflowed_; ++body) {
      if (has(body) && proxies_[body].moves) find_pairs_of(body, accept);
    }
    return pairs_;
  }

  [[nodiscard]] bool overflowed() const { return overflowed_; }

  /// Calls `visit(body)` for every body whose fattened bounds pass `test(bounds)`.
  template <class Test, class Visit>
  void traverse(Test&& test, Visit&& visit) const {
    static_tree_.traverse(test, visit);
    moving_tree_.traverse(test, visit);
  }

  [[nodiscard]] bool is_valid() const { return static_tree_.is_valid() && moving_tree_.is_valid(); }

 private:
  static constexpr std::uint32_t k_absent = BoundingVolumeTree::k_null;

  struct Proxy {
    Bounds bounds;
    std::uint32_t leaf = k_absent;
    bool moves = false;
  };

  template <class Accept>
  void find_pairs_of(std::uint32_t body, Accept&& accept) {
    const Bounds& bounds = proxies_[body].bounds;
    partners_.clear();
    const auto test = [&](const Bounds& other) { return overlap(bounds, other); };
    const auto keep = [&](std::uint32_t other) {
      const Proxy& proxy = proxies_[other];
      const bool mine = !proxy.moves || other > body;
      if (mine && overlap(bounds, proxy.bounds) && accept(body, other)) partners_.push_back(other);
    };
    traverse(test, keep);
    append_sorted(body);
  }

  void append_sorted(std::uint32_t body);

  [[nodiscard]] BoundingVolumeTree& tree(bool moves) { return moves ? moving_tree_ : static_tree_; }

  BoundingVolumeTree static_tree_;
  BoundingVolumeTree moving_tree_;
  std::vector<Proxy> proxies_;           // by body index
  std::vector<std::uint32_t> partners_;  // of the body at hand; capacity: all bodies
  std::vector<Pair> pairs_;
  std::size_t pair_capacity_;
  bool overflowed_ = false;
};

}  // namespace lockstone
