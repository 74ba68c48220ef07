// How full the pools of a tick are that its islands share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace lockstone {

/// The fill of the fullest pool, and whether any pool had no room for somebody. Two sets of islands
/// that fit beside each other are given the same places together as alone.
class PoolUse {
 public:
  void add(std::size_t used, std::size_t capacity) {
    if (used == 0) return;
    const std::uint64_t parts =
        capacity == 0 ? k_full + 1 : (std::uint64_t{used} * k_full + capacity - 1) / capacity;
    parts_ = std::max(parts_, parts);
  }
  void add(const PoolUse& other) { parts_ = std::max(parts_, other.parts_); }
  /// Somebody found no room.
  void note_exhausted() { parts_ = k_full + 1; }

  [[nodiscard]] bool is_exhausted() const { return parts_ > k_full; }

  /// An upper bound of the places of both together: exhausted unless both surely fit.
  [[nodiscard]] PoolUse beside(const PoolUse& other) const {
    PoolUse both;
    both.parts_ = parts_ + other.parts_;
    return both;
  }

 private:
  static constexpr std::uint64_t k_full = 1U << 20;

  std::uint64_t parts_ = 0;  // of k_full, rounded up
};

}  // namespace lockstone
