// Which pairs of bodies a tick looks at.
#pragma once

#include <span>

#include "core/collision/broad_phase/pair.h"

namespace lockstone {

/// A tick of a part of the world. An interface, so that programs that step whole worlds alone do
/// not contain the code that chooses parts.
class PairFilter {
 public:
  PairFilter() = default;
  PairFilter(const PairFilter&) = delete;
  PairFilter& operator=(const PairFilter&) = delete;
  virtual ~PairFilter() = default;

  /// Of all pairs, in order, those that the tick is about; valid until the next call.
  [[nodiscard]] virtual std::span<const Pair> take_pairs(std::span<const Pair> all) = 0;
};

}  // namespace lockstone
