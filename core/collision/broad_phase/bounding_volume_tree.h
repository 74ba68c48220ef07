// A dynamic tree of bounding boxes, after the incremental surface-area insertion of E. Catto,
// "Dynamic Bounding Volume Hierarchies", GDC 2019. Derived data: its shape never shows in a result.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/unset_array.h"
#include "core/collision/broad_phase/bounds.h"
#include "core/collision/broad_phase/proxy.h"

namespace lockstone {

class BoundingVolumeTree {
 public:
  static constexpr std::uint32_t k_null = 0xffffffff;

  /// Room for `leaf_capacity` leaves; nothing is allocated afterwards.
  explicit BoundingVolumeTree(std::uint32_t leaf_capacity);

  void clear();

  /// Adds a leaf; returns the node that stands for it until `remove`.
  std::uint32_t insert(const Bounds& bounds, const Layers& layers, std::uint32_t body);
  void remove(std::uint32_t leaf);

  /// A leaf for `build`: `middle` is that of its bounds.
  struct Item {
    Vec3<BoundsCoordinate> middle;
    std::uint32_t leaf = k_null;
  };

  /// Building at once, after `clear`: a leaf that no node holds yet, and all of them as one tree.
  /// Changes the order of `items`.
  [[nodiscard]] Item make_leaf(const Bounds& bounds, const Layers& layers, std::uint32_t body);
  void build(std::span<Item> items);

  /// Calls `visit(body)` for every leaf whose bounds and layers pass `test(bounds, layers)`, in no
  /// promised order. A test that fails for a box must fail for every box inside it.
  template <class Test, class Visit>
  void traverse(Test&& test, Visit&& visit) const {
    std::uint32_t stack[k_stack_capacity];
    int size = 0;
    if (root_ != k_null) stack[size++] = root_;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!test(node.bounds, node.layers)) continue;
      if (node.is_leaf()) {
        visit(node.body());
        continue;
      }
      LKS_CHECK(size + 2 <= k_stack_capacity);
      stack[size++] = node.child[0];
      stack[size++] = node.child[1];
    }
  }

  /// Calls `visit(body, other)` once for every two leaves whose bounds overlap and whose layers may
  /// collide, in no promised order. Stops when it returns false, and returns that.
  template <class Visit>
  bool visit_pairs(Visit&& visit) const {
    UnsetArray<NodePair, k_pair_stack_capacity> stack;
    std::size_t size = 0;
    const auto push = [&](std::uint32_t a, std::uint32_t b) { stack[size++] = {a, b}; };
    const auto push_if_close = [&](std::uint32_t a, std::uint32_t b) {
      const Node& one = nodes_[a];
      const Node& other = nodes_[b];
      if (overlap(one.bounds, other.bounds) && may_collide(one.layers, other.layers)) push(a, b);
    };
    if (root_ != k_null) push(root_, root_);
    while (size > 0) {
      const NodePair at = stack[--size];
      const Node& one = nodes_[at.one];
      const Node& other = nodes_[at.other];
      LKS_CHECK(size + 3 <= k_pair_stack_capacity);
      if (at.one == at.other) {
        if (one.is_leaf()) continue;
        push(one.child[0], one.child[0]);
        push(one.child[1], one.child[1]);
        push_if_close(one.child[0], one.child[1]);
      } else if (one.is_leaf() && other.is_leaf()) {
        if (!visit(one.body(), other.body())) return false;
      } else if (one.height >= other.height) {
        push_if_close(one.child[0], at.other);
        push_if_close(one.child[1], at.other);
      } else {
        push_if_close(at.one, other.child[0]);
        push_if_close(at.one, other.child[1]);
      }
    }
    return true;
  }

  /// Height of the tree, 0 when empty or a single leaf.
  [[nodiscard]] int height() const;

  /// Checks links, bounds and heights; for tests.
  [[nodiscard]] bool is_valid() const;

 private:
  // Rotations keep the tree near balance; 2^20 leaves stay far below this depth.
  static constexpr int k_stack_capacity = 256;
  // A pair gives way to three at most, one level lower in one of the two nodes.
  static constexpr std::size_t k_pair_stack_capacity = 4 * k_stack_capacity;

  struct Node {
    Bounds bounds;
    Layers layers;
    std::int16_t height = 0;                    // -1: free
    std::uint32_t parent = k_null;              // the next free node when this one is free
    std::uint32_t child[2] = {k_null, k_null};  // of a leaf: null and the body

    [[nodiscard]] bool is_leaf() const { return child[0] == k_null; }
    [[nodiscard]] std::uint32_t body() const { return child[1]; }
  };

  struct NodePair {
    std::uint32_t one = k_null;
    std::uint32_t other = k_null;
  };

  std::uint32_t build_below(std::span<Item> items);
  std::uint32_t allocate();
  void release(std::uint32_t node);
  [[nodiscard]] std::uint32_t best_sibling(const Bounds& bounds) const;
  void replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child);
  void refit_upward(std::uint32_t node);
  void refit(std::uint32_t node);
  void balance(std::uint32_t node);
  void swap_nodes(std::uint32_t node, int side, int grandchild);
  [[nodiscard]] bool is_valid_below(std::uint32_t node) const;

  std::vector<Node> nodes_;
  std::uint32_t root_ = k_null;
  std::uint32_t free_ = k_null;
};

}  // namespace lockstone
