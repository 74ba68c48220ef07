// Axes that parted pairs of bodies a tick ago. Derived: any axis may be missing or stale, for each
// is tried before it is believed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/collision/broad_phase/pair.h"

namespace lockstone {

class SeparatingAxes {
 public:
  /// From A to B in world axes; zero when none is known.
  struct Entry {
    Pair pair{};
    Vec3<Unit> axis{};
  };

  /// The axes of the tick before, read by ascending pairs.
  class Reader {
   public:
    explicit Reader(std::span<const Entry> entries) : entries_(entries) {}

    /// Zero when the pair is new or was not parted.
    [[nodiscard]] Vec3<Unit> axis_of(const Pair& pair) {
      while (!entries_.empty() && entries_.front().pair < pair)
        entries_ = entries_.subspan(1);
      return !entries_.empty() && entries_.front().pair == pair ? entries_.front().axis
                                                                : Vec3<Unit>{};
    }

   private:
    std::span<const Entry> entries_;
  };

  /// Makes room; the only function that allocates.
  void reserve(std::size_t pairs) {
    before_.reserve(pairs);
    now_.reserve(pairs);
  }

  void forget() { now_.clear(); }

  /// A tick with this many pairs. Each must be noted.
  void begin(std::size_t pairs) {
    std::swap(before_, now_);
    now_.resize(pairs);
  }

  [[nodiscard]] Reader read_from(const Pair& first) const {
    const auto begin = std::ranges::lower_bound(before_, first, {}, &Entry::pair);
    return Reader(std::span(before_).subspan(static_cast<std::size_t>(begin - before_.begin())));
  }

  /// Pairs are noted in any order, each by its own index.
  void note(std::size_t index, const Pair& pair, const Vec3<Unit>& axis) {
    now_[index] = {pair, axis};
  }

 private:
  std::vector<Entry> before_;  // by pair
  std::vector<Entry> now_;     // by pair, once all are noted
};

}  // namespace lockstone
