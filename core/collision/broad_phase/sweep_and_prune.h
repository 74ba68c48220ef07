// The broad phase by sweep and prune: boxes in a list sorted by their lower ends along one axis.
//
// Sorting by insertion from tick to tick after D. Baraff, "Dynamic simulation of non-penetrating
// rigid bodies", 1992, and J. Cohen, M. Lin, D. Manocha, M. Ponamgi, "I-COLLIDE", 1995; lower ends
// alone, in one array, after P. Terdiman, "Box pruning revisited", 2017. Three axes with a list of
// endpoints each would find single changes in less time, but pay for every two endpoints that pass
// each other on any axis, whether the boxes come close or not, and cannot be made again in one go.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

#include "core/collision/broad_phase/proxy.h"

namespace lockstone {

class SweepAndPrune {
 public:
  explicit SweepAndPrune(std::uint32_t body_capacity);

  void clear();

  // The lists change in `refresh` only.
  void put(std::uint32_t) {}
  void remove(std::uint32_t) {}

  /// Brings the lists up to date. Everything that was put or removed since must be in `touched`,
  /// once, and `is_touched` by body must say the same.
  void refresh(std::span<const std::uint32_t> touched, std::span<const Proxy> proxies,
               std::span<const std::uint8_t> is_touched);

  /// Calls `emit(a, b)` once, in no promised order, for every two bodies of which one is touched
  /// and one moves and whose fat boxes overlap. Stops when it returns false, and returns that.
  template <class Emit>
  bool search(std::span<const std::uint32_t>, std::span<const Proxy>,
              std::span<const std::uint8_t> is_touched, Emit&& emit) {
    split(is_touched);
    return within(touched_, emit) && between(touched_, untouched_, emit) &&
           between(touched_, lists_[0], emit) && between(untouched_, touched_standing_, emit);
  }

  /// Lists are sorted, without a hole; for tests.
  [[nodiscard]] bool is_valid() const;

 private:
  // A box whose first axis is the one of the sweep.
  struct Entry {
    Bounds box;
    std::uint32_t body = 0;

    // Ties go to the lower body, so that there is one order.
    friend constexpr bool operator<(const Entry& a, const Entry& b) {
      return a.box.lower.x != b.box.lower.x ? a.box.lower.x < b.box.lower.x : a.body < b.body;
    }
  };
  enum class Listed : std::uint8_t { nowhere, standing, moving };

  static constexpr Listed k_lists[] = {Listed::standing, Listed::moving};

  [[nodiscard]] static bool belongs(const Proxy& proxy, Listed kind);
  void update(std::vector<Entry>& list, Listed kind, std::span<const Proxy> proxies,
              std::span<const std::uint8_t> is_touched);
  [[nodiscard]] bool concerns(Listed kind, std::span<const std::uint32_t> touched,
                              std::span<const Proxy> proxies) const;
  [[nodiscard]] Entry entry_of(std::uint32_t body, const Proxy& proxy) const;
  [[nodiscard]] int widest_axis() const;
  void turn(int axis, std::span<const Proxy> proxies);
  static void sort(std::vector<Entry>& list);
  void split(std::span<const std::uint8_t> is_touched);

  // Their first axes are known to overlap.
  [[nodiscard]] static bool overlap_across(const Bounds& a, const Bounds& b) {
    return static_cast<int>(a.lower.y <= b.upper.y) & static_cast<int>(b.lower.y <= a.upper.y) &
           static_cast<int>(a.lower.z <= b.upper.z) & static_cast<int>(b.lower.z <= a.upper.z);
  }

  // Entries of `list` from `first` on that begin within `one`.
  template <class Emit>
  static bool sweep(const Entry& one, const std::vector<Entry>& list, std::size_t first,
                    Emit&& emit) {
    const BoundsCoordinate end = one.box.upper.x;
    for (std::size_t i = first; i < list.size() && list[i].box.lower.x <= end; ++i) {
      if (overlap_across(one.box, list[i].box) && !emit(one.body, list[i].body)) return false;
    }
    return true;
  }

  template <class Emit>
  static bool within(const std::vector<Entry>& list, Emit&& emit) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!sweep(list[i], list, i + 1, emit)) return false;
    }
    return true;
  }

  // Of two boxes that overlap, the one that begins later begins within the other.
  template <class Emit>
  static bool between(const std::vector<Entry>& a, const std::vector<Entry>& b, Emit&& emit) {
    return begin_within(a, b, emit) && begin_within(b, a, emit);
  }

  template <class Emit>
  static bool begin_within(const std::vector<Entry>& outer, const std::vector<Entry>& inner,
                           Emit&& emit) {
    LKS_ASSERT(std::is_sorted(outer.begin(), outer.end()) &&
               std::is_sorted(inner.begin(), inner.end()));
    std::size_t first = 0;
    for (const Entry& one : outer) {
      while (first < inner.size() && inner[first] < one)
        ++first;
      if (first == inner.size()) break;
      if (!sweep(one, inner, first, emit)) return false;
    }
    return true;
  }

  std::vector<Entry> lists_[2];  // standing; moving
  std::vector<Listed> listed_;   // by body
  int axis_ = 0;
  std::uint32_t refreshes_ = 0;

  // Of one search: the moving bodies, in two parts, and the touched ones of the standing.
  std::vector<Entry> touched_, untouched_, touched_standing_;
};

}  // namespace lockstone
