// A bounding-volume tree that is built once: for meshes and large compounds.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <lockstone/assert.h>

#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/slab_tests.h"

namespace lockstone::geometry {

/// Items are renumbered in the order of the leaves, so that a walk from left to right meets them in
/// ascending order. Nodes lie in that order too, each with the place where its subtree ends: an
/// overlap query needs no stack (Smits, Efficiency issues for ray tracing, "skip pointers").
class StaticTree {
 public:
  static constexpr int k_leaf_items = 4;
  static constexpr std::uint32_t k_max_items = std::uint32_t{1} << 24;
  static constexpr int k_max_depth = 48;

  StaticTree() = default;

  /// At most k_max_items. Afterwards order[k] is the former number of item k. The tree is a
  /// function of the bounds in their order.
  [[nodiscard]] static StaticTree build(std::span<const LocalBounds> items,
                                        std::vector<std::uint32_t>& order);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] const LocalBounds& bounds() const { return nodes_.front().bounds; }
  [[nodiscard]] std::size_t memory_bytes() const { return nodes_.size() * sizeof(Node); }

  /// Levels below the root; at most k_max_depth.
  [[nodiscard]] int depth() const;

  /// Calls visit(first, count) for the leaves whose bounds meet `region`, ascending. The contents
  /// of a leaf have still to be tested.
  template <class Visit>
  void overlapping(const LocalBounds& region, Visit&& visit) const {
    const auto end = static_cast<std::uint32_t>(nodes_.size());
    for (std::uint32_t at = 0; at < end;) {
      const Node& node = nodes_[at];
      if (!overlap(node.bounds, region)) {
        at = node.end;
        continue;
      }
      if (node.is_leaf()) visit(node.first(), node.count());
      ++at;
    }
  }

  /// Calls visit(first, count, limit) for leaves that the window (RayWindow, NearWindow) may meet
  /// within `limit`, the nearer of two siblings first; each call returns the new limit, at most the
  /// old.
  template <class Window, class Visit>
  void nearest_first(const Window& window, std::int64_t limit, Visit&& visit) const {
    std::array<Entry, k_max_depth + 1> stack;
    std::size_t size = 0;
    if (Entry root; !empty() && window.meets(bounds(), limit, root.at)) stack[size++] = root;
    while (size > 0) {
      const Entry here = stack[--size];
      if (here.at > limit) continue;
      const Node& node = nodes_[here.node];
      if (node.is_leaf()) {
        limit = visit(node.first(), node.count(), limit);
        continue;
      }
      Entry near{here.node + 1};
      Entry far{nodes_[near.node].end};
      bool near_met = window.meets(nodes_[near.node].bounds, limit, near.at);
      bool far_met = window.meets(nodes_[far.node].bounds, limit, far.at);
      if (far.at < near.at) {
        std::swap(near, far);
        std::swap(near_met, far_met);
      }
      LKS_CHECK(size + 2 <= stack.size());
      if (far_met) stack[size++] = far;
      if (near_met) stack[size++] = near;
    }
  }

 private:
  struct Node {
    LocalBounds bounds;
    std::uint32_t end = 0;    ///< of the subtree: the node after its last one
    std::uint32_t items = 0;  ///< of a leaf: the first one · 8 + their number; 0: not a leaf

    [[nodiscard]] bool is_leaf() const { return items != 0; }
    [[nodiscard]] std::uint32_t first() const { return items >> 3; }
    [[nodiscard]] std::uint32_t count() const { return items & 7; }
  };
  static_assert(sizeof(Node) == 32 && k_leaf_items <= 7);

  struct Entry {
    std::uint32_t node = 0;
    std::int64_t at = 0;
  };

  friend class StaticTreeBuilder;

  std::vector<Node> nodes_;
};

}  // namespace lockstone::geometry
