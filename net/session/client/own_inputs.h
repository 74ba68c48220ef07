// A player's own inputs, from their sampling until the server has them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/net/client.h>
#include <lockstone/net/wire.h>

#include "net/session/tick_ring.h"

namespace lockstone::net {

/// Every tick is sampled once, in order; no input is sampled for a tick that the server has
/// replaced. Allocates when made only.
class OwnInputs {
 public:
  OwnInputs() = default;
  explicit OwnInputs(std::uint8_t input_bytes)
      : inputs_(std::size_t{4} * k_input_window_ticks, input_bytes) {}

  /// Ticks below are sampled.
  [[nodiscard]] std::uint64_t sampled() const { return sampled_; }
  /// Ticks below need not be sent.
  [[nodiscard]] std::uint64_t acknowledged() const { return acknowledged_; }

  /// The input of a tick; an empty view if it is not kept, or was never sampled.
  [[nodiscard]] ByteView find(std::uint64_t tick) const { return inputs_.find(tick); }
  [[nodiscard]] bool has(std::uint64_t tick) const { return inputs_.has(tick); }

  /// The player is seated: there are no inputs for the first `delay_ticks`.
  void begin(std::uint64_t delay_ticks) {
    sampled_ = std::max(sampled_, delay_ticks);
    acknowledged_ = sampled_;
  }

  /// The player plays from `tick` on.
  void activate(std::uint64_t tick) {
    acknowledged_ = tick;
    sampled_ = std::max(sampled_, tick);
  }

  /// The server has the inputs of ticks below `tick`, or has replaced them.
  void acknowledge(std::uint64_t tick) {
    acknowledged_ = std::max(acknowledged_, tick);
    sampled_ = std::max(sampled_, acknowledged_);
  }

  /// The match went back: ticks are sampled again.
  void forget() { sampled_ = acknowledged_ = 0; }

  /// Samples ticks below `end`; returns whether there were any.
  bool sample(std::uint64_t end, InputSource& source) {
    const bool any = sampled_ < end;
    for (; sampled_ < end; ++sampled_) {
      const std::span<std::byte> place = inputs_.claim(sampled_);
      std::fill(place.begin(), place.end(), std::byte{0});
      source.sample(sampled_, place);
      inputs_.commit(sampled_, place.size());
    }
    return any;
  }

 private:
  TickRing inputs_;
  std::uint64_t sampled_ = 0;
  std::uint64_t acknowledged_ = 0;
};

}  // namespace lockstone::net
