#include "core/collision/broad_phase/bounding_volume_tree.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {

BoundingVolumeTree::BoundingVolumeTree(std::uint32_t leaf_capacity) {
  nodes_.resize(std::size_t{2} * std::max(leaf_capacity, 1U));
  clear();
}

void BoundingVolumeTree::clear() {
  root_ = k_null;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    nodes_[i].parent = static_cast<std::uint32_t>(i + 1);
    nodes_[i].height = -1;
  }
  nodes_.back().parent = k_null;
  free_ = 0;
}

std::uint32_t BoundingVolumeTree::allocate() {
  LKS_CHECK(free_ != k_null);
  const std::uint32_t node = free_;
  free_ = nodes_[node].parent;
  LKS_ASSERT(nodes_[node].height == -1);
  nodes_[node] = Node{};
  return node;
}

void BoundingVolumeTree::release(std::uint32_t node) {
  LKS_ASSERT(nodes_[node].height >= 0);
  nodes_[node].parent = free_;
  nodes_[node].height = -1;
  free_ = node;
}

std::uint32_t BoundingVolumeTree::insert(const Bounds& bounds, const Layers& layers,
                                         std::uint32_t body) {
  const std::uint32_t leaf = allocate();
  nodes_[leaf].bounds = bounds;
  nodes_[leaf].layers = layers;
  nodes_[leaf].child[1] = body;
  if (root_ == k_null) {
    root_ = leaf;
    return leaf;
  }
  const std::uint32_t sibling = best_sibling(bounds);
  LKS_ASSERT(sibling != leaf);
  const std::uint32_t parent = allocate();
  const std::uint32_t grandparent = nodes_[sibling].parent;
  nodes_[parent].parent = grandparent;
  nodes_[parent].child[0] = sibling;
  nodes_[parent].child[1] = leaf;
  nodes_[sibling].parent = parent;
  nodes_[leaf].parent = parent;
  replace_child(grandparent, sibling, parent);
  refit_upward(parent);
  return leaf;
}

BoundingVolumeTree::Item BoundingVolumeTree::make_leaf(const Bounds& bounds, const Layers& layers,
                                                       std::uint32_t body) {
  LKS_ASSERT(bounds.lower.x <= bounds.upper.x && bounds.lower.y <= bounds.upper.y &&
             bounds.lower.z <= bounds.upper.z);
  const std::uint32_t leaf = allocate();
  nodes_[leaf].bounds = bounds;
  nodes_[leaf].layers = layers;
  nodes_[leaf].child[1] = body;
  Item item;
  for (int i = 0; i < 3; ++i)
    item.middle[i].raw = bounds.lower[i].raw / 2 + bounds.upper[i].raw / 2;
  item.leaf = leaf;
  return item;
}

void BoundingVolumeTree::build(std::span<Item> items) {
  root_ = items.empty() ? k_null : build_below(items);
}

// Halves by the median along the axis where the middles lie farthest apart.
std::uint32_t BoundingVolumeTree::build_below(std::span<Item> items) {
  if (items.size() == 1) return items.front().leaf;
  LKS_ASSERT(items.size() >= 2);
  Bounds spread{items.front().middle, items.front().middle};
  for (const Item& item : items)
    spread = united(spread, {item.middle, item.middle});
  int axis = 0;
  const auto length = [&](int i) {
    return std::int64_t{spread.upper[i].raw} - spread.lower[i].raw;
  };
  for (int i = 1; i < 3; ++i) {
    if (length(i) > length(axis)) axis = i;
  }
  const std::size_t half = items.size() / 2;
  LKS_ASSERT(half > 0 && half < items.size());
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [axis](const Item& a, const Item& b) {
                     return std::pair(a.middle[axis], a.leaf) < std::pair(b.middle[axis], b.leaf);
                   });
  const std::uint32_t node = allocate();
  const std::uint32_t children[] = {build_below(items.first(half)),
                                    build_below(items.subspan(half))};
  for (int side = 0; side < 2; ++side) {
    nodes_[node].child[side] = children[side];
    nodes_[children[side]].parent = node;
  }
  refit(node);
  return node;
}

void BoundingVolumeTree::remove(std::uint32_t leaf) {
  LKS_ASSERT(leaf < nodes_.size() && nodes_[leaf].is_leaf() && nodes_[leaf].height == 0);
  const std::uint32_t parent = nodes_[leaf].parent;
  release(leaf);
  if (parent == k_null) {
    root_ = k_null;
    return;
  }
  const Node& removed = nodes_[parent];
  const std::uint32_t sibling = removed.child[0] == leaf ? removed.child[1] : removed.child[0];
  const std::uint32_t grandparent = removed.parent;
  nodes_[sibling].parent = grandparent;
  replace_child(grandparent, parent, sibling);
  release(parent);
  if (grandparent != k_null) refit_upward(grandparent);
}

// Greedy descent: stop where pairing with this node costs less than going on below it.
std::uint32_t BoundingVolumeTree::best_sibling(const Bounds& bounds) const {
  LKS_ASSERT(root_ != k_null);
  std::uint32_t node = root_;
  while (!nodes_[node].is_leaf()) {
    const std::int64_t area = surface_cost(nodes_[node].bounds);
    const std::int64_t joined = surface_cost(united(nodes_[node].bounds, bounds));
    const std::int64_t inherited = joined - area;
    std::int64_t cost[2];
    for (int side = 0; side < 2; ++side) {
      const Node& child = nodes_[nodes_[node].child[side]];
      cost[side] = surface_cost(united(child.bounds, bounds)) + inherited;
      if (!child.is_leaf()) cost[side] -= surface_cost(child.bounds);
    }
    if (joined <= cost[0] && joined <= cost[1]) break;
    node = nodes_[node].child[cost[1] < cost[0] ? 1 : 0];
  }
  return node;
}

void BoundingVolumeTree::replace_child(std::uint32_t parent, std::uint32_t old_child,
                                       std::uint32_t new_child) {
  if (parent == k_null) {
    root_ = new_child;
    return;
  }
  Node& node = nodes_[parent];
  LKS_ASSERT(node.child[0] == old_child || node.child[1] == old_child);
  node.child[node.child[0] == old_child ? 0 : 1] = new_child;
}

void BoundingVolumeTree::refit_upward(std::uint32_t node) {
  LKS_ASSERT(node != k_null && !nodes_[node].is_leaf());
  for (; node != k_null; node = nodes_[node].parent) {
    balance(node);
    refit(node);
  }
}

void BoundingVolumeTree::refit(std::uint32_t index) {
  LKS_ASSERT(!nodes_[index].is_leaf());
  Node& node = nodes_[index];
  const Node& a = nodes_[node.child[0]];
  const Node& b = nodes_[node.child[1]];
  node.bounds = united(a.bounds, b.bounds);
  node.layers = united(a.layers, b.layers);
  node.height = static_cast<std::int16_t>(1 + std::max(a.height, b.height));
}

// An AVL-like rule: when one side is more than one level higher, its higher child changes places
// with the other side.
void BoundingVolumeTree::balance(std::uint32_t index) {
  const Node& node = nodes_[index];
  const int difference = nodes_[node.child[1]].height - nodes_[node.child[0]].height;
  if (difference >= -1 && difference <= 1) return;
  const int high = difference > 0 ? 1 : 0;
  const Node& tall = nodes_[node.child[high]];
  LKS_ASSERT(!tall.is_leaf());
  const int grandchild = nodes_[tall.child[1]].height > nodes_[tall.child[0]].height ? 1 : 0;
  swap_nodes(index, high, grandchild);
}

// node → (low, tall → (keep, lift)) becomes node → (tall → (keep, low), lift).
void BoundingVolumeTree::swap_nodes(std::uint32_t index, int high, int grandchild) {
  Node& node = nodes_[index];
  const std::uint32_t tall = node.child[high];
  const std::uint32_t low = node.child[1 - high];
  const std::uint32_t lift = nodes_[tall].child[grandchild];
  LKS_ASSERT(nodes_[lift].parent == tall && nodes_[low].parent == index);
  node.child[1 - high] = lift;
  nodes_[lift].parent = index;
  nodes_[tall].child[grandchild] = low;
  nodes_[low].parent = tall;
  balance(tall);  // the low side may be much lower than the rest
  refit(tall);
}

int BoundingVolumeTree::height() const {
  return root_ == k_null ? 0 : nodes_[root_].height;
}

bool BoundingVolumeTree::is_valid() const {
  return root_ == k_null || (nodes_[root_].parent == k_null && is_valid_below(root_));
}

bool BoundingVolumeTree::is_valid_below(std::uint32_t index) const {
  LKS_ASSERT(index < nodes_.size());
  const Node& node = nodes_[index];
  if (node.is_leaf()) return node.height == 0;
  const Node& a = nodes_[node.child[0]];
  const Node& b = nodes_[node.child[1]];
  return a.parent == index && b.parent == index && node.bounds == united(a.bounds, b.bounds) &&
         node.layers == united(a.layers, b.layers) &&
         node.height == 1 + std::max(a.height, b.height) && is_valid_below(node.child[0]) &&
         is_valid_below(node.child[1]);
}

}  // namespace lockstone
