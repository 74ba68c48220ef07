// The broad phase by trees: one for static and kinematic bodies and one for dynamic bodies.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

#include "core/collision/broad_phase/bounding_volume_tree.h"
#include "core/collision/broad_phase/proxy.h"

namespace lockstone {

class TreeSearch {
 public:
  explicit TreeSearch(std::uint32_t body_capacity)
      : trees_{BoundingVolumeTree(body_capacity), BoundingVolumeTree(body_capacity)},
        places_(body_capacity) {
    waiting_.reserve(body_capacity);
    items_.reserve(body_capacity);
  }

  void clear();

  /// Adds the body, or takes over its new box or traits, at the next `refresh`. Until then it is
  /// found without the trees.
  void put(std::uint32_t body);
  void remove(std::uint32_t body);

  /// Puts the waiting bodies into the trees: one by one, or a tree as a whole when much of it
  /// changes.
  void refresh(std::span<const Proxy> proxies);

  /// Between two refreshes: does the same when many bodies wait, which make a traversal slow. The
  /// next refresh builds a tree again if it would have without this.
  void refresh_when_many(std::span<const Proxy> proxies);

  /// Calls `emit(a, b)` once, in no promised order, for every two bodies of which one is touched
  /// and one moves, whose fat boxes overlap and whose layers may collide. Stops when it returns
  /// false, and returns that.
  template <class Emit>
  bool search(std::span<const std::uint32_t> touched, std::span<const Proxy> proxies,
              std::span<const std::uint8_t> is_touched, Emit&& emit) const {
    const bool many = touched.size() > leaves_[1] / 2;
    if (many && !search_dynamic(is_touched, emit)) return false;
    bool goes_on = true;
    for (const std::uint32_t body : touched) {
      const Proxy& proxy = proxies[body];
      LKS_ASSERT(body < is_touched.size() && is_touched[body] != 0);
      if (!proxy.present) continue;
      const Layers layers = layers_of(proxy.traits.filter);
      const auto test = [&](const Bounds& other, const Layers& others) {
        return goes_on && overlap(proxy.fat, other) && may_collide(layers, others);
      };
      const auto visit = [&](std::uint32_t other) {
        const bool others = is_touched[other] != 0 && other <= body;
        if (!others) goes_on = goes_on && emit(body, other);
      };
      trees_[0].traverse(test, visit);
      if (!many || !proxy.traits.is_dynamic) trees_[1].traverse(test, visit);
    }
    return goes_on;
  }

  /// Calls `visit(body)` for the bodies whose category is in `mask` and whose fat box passes
  /// `test`: all of them, or perhaps no dynamic ones.
  template <class Test, class Visit>
  void traverse(std::uint32_t mask, bool with_dynamic, Test&& test, Visit&& visit) const {
    const auto passes = [&](const Bounds& bounds, const Layers& layers) {
      return (layers.categories & mask) != 0 && test(bounds);
    };
    const auto settled = [&](std::uint32_t body) {
      if (!places_[body].waits) visit(body);
    };
    trees_[0].traverse(passes, settled);
    if (with_dynamic) trees_[1].traverse(passes, settled);
    for (const std::uint32_t body : waiting_)
      if (places_[body].waits) visit(body);
  }

  [[nodiscard]] bool is_valid() const { return trees_[0].is_valid() && trees_[1].is_valid(); }

 private:
  static constexpr std::uint32_t k_null = BoundingVolumeTree::k_null;
  using Counts = std::array<std::uint32_t, 2>;  // of bodies, by tree

  // The pairs of two dynamic bodies, all at once: each is met once, and one way down the tree
  // serves many bodies. With as many touched as not it takes as long as a search for each.
  template <class Emit>
  bool search_dynamic(std::span<const std::uint8_t> is_touched, Emit&& emit) const {
    return trees_[1].visit_pairs([&](std::uint32_t body, std::uint32_t other) {
      return (is_touched[body] | is_touched[other]) == 0 || emit(body, other);
    });
  }

  // Where a body's leaf is. That of a body that waits, if it has one, is out of date.
  struct Place {
    std::uint32_t leaf = k_null;
    bool is_dynamic = false;
    bool waits = false;
    bool listed = false;  // in waiting_, perhaps in vain
  };

  void remove_leaf(Place& place);
  void insert(std::uint32_t body, const Proxy& proxy);
  Counts put_waiting(std::span<const Proxy> proxies, const Counts& early);
  void rebuild(bool dynamic, std::span<const Proxy> proxies);

  BoundingVolumeTree trees_[2];  // of static and kinematic bodies; of dynamic bodies
  Counts leaves_{};
  Counts inserted_{};          // one by one, since all were put in at once
  Counts early_{};             // put in by `refresh_when_many` since the last refresh
  std::vector<Place> places_;  // by body
  std::vector<std::uint32_t> waiting_;
  std::vector<BoundingVolumeTree::Item> items_;
};

}  // namespace lockstone
