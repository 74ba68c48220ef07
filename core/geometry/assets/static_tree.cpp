#include "core/geometry/assets/static_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace lockstone::geometry {
namespace {

constexpr int k_bins = 16;

/// Levels split by cost; below, halves keep the depth bounded: 2^24 items need 22 levels of them.
constexpr int k_cost_levels = 26;

constexpr LocalBounds k_no_bounds{{Length::max(), Length::max(), Length::max()},
                                  {Length::min(), Length::min(), Length::min()}};

LocalBounds merged(const LocalBounds& a, const LocalBounds& b) {
  return {{min(a.lower.x, b.lower.x), min(a.lower.y, b.lower.y), min(a.lower.z, b.lower.z)},
          {max(a.upper.x, b.upper.x), max(a.upper.y, b.upper.y), max(a.upper.z, b.upper.z)}};
}

std::int64_t extent(const LocalBounds& box, int axis) {
  return std::int64_t{box.upper[axis].raw} - box.lower[axis].raw;
}

/// Twice the centre.
std::int64_t centre(const LocalBounds& box, int axis) {
  return std::int64_t{box.lower[axis].raw} + box.upper[axis].raw;
}

/// Half the surface of boxes within one box, in a unit that keeps the sum over all items in 64
/// bits.
struct AreaScale {
  int shift = 0;

  explicit AreaScale(const LocalBounds& box) {
    const std::int64_t longest = std::max({extent(box, 0), extent(box, 1), extent(box, 2)});
    shift = std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(longest))) - 18);
  }

  /// At most 3 · 2^36.
  [[nodiscard]] std::int64_t area(const LocalBounds& box) const {
    const std::int64_t x = extent(box, 0) >> shift;
    const std::int64_t y = extent(box, 1) >> shift;
    const std::int64_t z = extent(box, 2) >> shift;
    return x * y + y * z + z * x;
  }
};

struct Bin {
  LocalBounds bounds = k_no_bounds;
  std::int64_t count = 0;

  void add(const Bin& other) {
    bounds = merged(bounds, other.bounds);
    count += other.count;
  }
};

/// Maps centres along one axis to bins.
struct BinAxis {
  std::int64_t lowest = std::numeric_limits<std::int64_t>::max();
  std::int64_t highest = std::numeric_limits<std::int64_t>::min();

  void include(std::int64_t c) {
    lowest = std::min(lowest, c);
    highest = std::max(highest, c);
  }
  [[nodiscard]] bool is_flat() const { return lowest == highest; }
  [[nodiscard]] int bin_of(std::int64_t c) const {
    return static_cast<int>((c - lowest) * k_bins / (highest - lowest + 1));
  }
};

/// Everything in bins up to `bin` of `axis` goes to the left.
struct Split {
  int axis = -1;
  int bin = 0;
  std::int64_t cost = std::numeric_limits<std::int64_t>::max();
};

using Bins = std::array<Bin, k_bins>;

/// The cheapest of the cuts between bins, by area × count on both sides.
void improve(Split& best, int axis, const Bins& bins, const AreaScale& scale) {
  std::array<std::int64_t, k_bins> right_cost{};
  Bin right;
  for (int i = k_bins - 1; i > 0; --i) {
    right.add(bins[static_cast<std::size_t>(i)]);
    right_cost[static_cast<std::size_t>(i)] =
        right.count == 0 ? -1 : scale.area(right.bounds) * right.count;
  }
  Bin left;
  for (int i = 0; i + 1 < k_bins; ++i) {
    left.add(bins[static_cast<std::size_t>(i)]);
    const std::int64_t beyond = right_cost[static_cast<std::size_t>(i) + 1];
    if (left.count == 0 || beyond < 0) continue;
    const std::int64_t cost = scale.area(left.bounds) * left.count + beyond;
    if (cost < best.cost) best = {axis, i, cost};
  }
}

}  // namespace

/// Top down; binned surface-area heuristic (Wald, On fast construction of SAH-based bounding volume
/// hierarchies).
class StaticTreeBuilder {
 public:
  StaticTreeBuilder(std::span<const LocalBounds> items, std::vector<std::uint32_t>& order,
                    StaticTree& tree)
      : items_(items), order_(order), nodes_(tree.nodes_) {}

  void add(std::uint32_t begin, std::uint32_t end, int level) {
    LKS_CHECK(level <= StaticTree::k_max_depth);
    const std::size_t index = nodes_.size();
    StaticTree::Node node;
    node.bounds = k_no_bounds;
    for (std::uint32_t i = begin; i < end; ++i)
      node.bounds = merged(node.bounds, item(i));
    if (end - begin <= StaticTree::k_leaf_items) node.items = (begin << 3) | (end - begin);
    nodes_.push_back(node);
    if (!node.is_leaf()) {
      const std::uint32_t middle = divide(begin, end, level, node.bounds);
      add(begin, middle, level + 1);
      add(middle, end, level + 1);
    }
    nodes_[index].end = static_cast<std::uint32_t>(nodes_.size());
  }

 private:
  [[nodiscard]] const LocalBounds& item(std::uint32_t i) const { return items_[order_[i]]; }

  std::uint32_t divide(std::uint32_t begin, std::uint32_t end, int level, const LocalBounds& box) {
    std::array<BinAxis, 3> axes;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (int axis = 0; axis < 3; ++axis)
        axes[static_cast<std::size_t>(axis)].include(centre(item(i), axis));
    }
    const Split split = level < k_cost_levels ? best_split(begin, end, box, axes) : Split{};
    if (split.axis < 0) return halve(begin, end, box);
    const BinAxis& bins = axes[static_cast<std::size_t>(split.axis)];
    const auto middle = std::stable_partition(at(begin), at(end), [&](std::uint32_t i) {
      return bins.bin_of(centre(items_[i], split.axis)) <= split.bin;
    });
    return static_cast<std::uint32_t>(middle - order_.begin());
  }

  [[nodiscard]] Split best_split(std::uint32_t begin, std::uint32_t end, const LocalBounds& box,
                                 const std::array<BinAxis, 3>& axes) const {
    const AreaScale scale(box);
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      const BinAxis& range = axes[static_cast<std::size_t>(axis)];
      if (range.is_flat()) continue;
      Bins bins;
      for (std::uint32_t i = begin; i < end; ++i) {
        const auto bin = static_cast<std::size_t>(range.bin_of(centre(item(i), axis)));
        bins[bin].add({item(i), 1});
      }
      improve(best, axis, bins, scale);
    }
    return best;
  }

  /// The lower half along the longest axis; equals by their number.
  std::uint32_t halve(std::uint32_t begin, std::uint32_t end, const LocalBounds& box) {
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (extent(box, axis) > extent(box, longest)) longest = axis;
    }
    std::sort(at(begin), at(end), [&](std::uint32_t i, std::uint32_t j) {
      const std::int64_t a = centre(items_[i], longest);
      const std::int64_t b = centre(items_[j], longest);
      return a != b ? a < b : i < j;
    });
    return begin + (end - begin) / 2;
  }

  [[nodiscard]] std::vector<std::uint32_t>::iterator at(std::uint32_t i) const {
    return order_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  std::span<const LocalBounds> items_;
  std::vector<std::uint32_t>& order_;
  std::vector<StaticTree::Node>& nodes_;
};

StaticTree StaticTree::build(std::span<const LocalBounds> items,
                             std::vector<std::uint32_t>& order) {
  LKS_CHECK(items.size() <= k_max_items);
  order.resize(items.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  StaticTree tree;
  if (items.empty()) return tree;
  tree.nodes_.reserve(items.size());
  StaticTreeBuilder(items, order, tree).add(0, static_cast<std::uint32_t>(items.size()), 0);
  tree.nodes_.shrink_to_fit();
  return tree;
}

int StaticTree::depth() const {
  // The ends of the subtrees that hold the node.
  std::vector<std::uint32_t> ends;
  std::size_t deepest = 1;
  for (std::uint32_t at = 0; at < nodes_.size(); ++at) {
    while (!ends.empty() && ends.back() <= at)
      ends.pop_back();
    ends.push_back(nodes_[at].end);
    deepest = std::max(deepest, ends.size());
  }
  return static_cast<int>(deepest) - 1;
}

}  // namespace lockstone::geometry
