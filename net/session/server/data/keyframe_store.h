// The states that delayed spectators may begin from: one at a fixed interval of ticks, the oldest
// overwritten.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/simulation.h>

#include "net/session/tick_ring.h"

namespace lockstone::net {

/// Holds the canonical snapshots of the last keyframes with their hashes. Keeps none where it
/// is made for states of no bytes. Allocates when made only.
class KeyframeStore {
 public:
  /// Enough of them for a spectator who is `delay_ticks` late.
  KeyframeStore(std::uint32_t interval_ticks, std::uint32_t delay_ticks, std::size_t bytes_max)
      : interval_(interval_ticks), hashes_(delay_ticks / interval_ticks + 4) {
    if (bytes_max > 0) states_ = TickRing(hashes_.size(), bytes_max);
  }

  [[nodiscard]] bool is_used() const { return states_.keeps_records(); }

  /// Called after every tick: keeps the state if it is a keyframe.
  void note(const Simulation& simulation);

  /// The ticks of the last keyframe at or before `ticks`.
  [[nodiscard]] std::uint64_t at_or_before(std::uint64_t ticks) const {
    return ticks / interval_ * interval_;
  }

  /// The state after `ticks` ticks, a keyframe's; an empty view if it is not kept.
  [[nodiscard]] ByteView find(std::uint64_t ticks) const { return states_.find(ticks / interval_); }
  [[nodiscard]] bool has(std::uint64_t ticks) const { return states_.has(ticks / interval_); }
  /// The hash of a state that is kept.
  [[nodiscard]] std::uint64_t hash_of(std::uint64_t ticks) const {
    return hashes_[static_cast<std::size_t>(ticks / interval_ % hashes_.size())];
  }

 private:
  std::uint64_t interval_;
  TickRing states_;  ///< by the number of ticks, divided by the interval
  std::vector<std::uint64_t> hashes_;
};

}  // namespace lockstone::net
