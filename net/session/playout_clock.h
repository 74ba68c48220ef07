// When to step a confirmed tick: late enough that nearly all ticks are there in time, so that the
// game moves evenly though packets do not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lockstone::net {

/// Measures the arrival of ticks against the tick rate. The depth of the jitter buffer is the 99th
/// percentile of the last 128 ticks' delay over the fastest of them, at most 250 ms.
class PlayoutClock {
 public:
  static constexpr std::size_t k_window = 128;
  static constexpr std::int64_t k_max_depth_us = 250'000;

  PlayoutClock() = default;
  explicit PlayoutClock(std::uint32_t tick_rate) : tick_rate_(tick_rate) {}

  /// `tick` and all before it are here. Ticks come in order.
  void arrived(std::uint64_t tick, std::int64_t now_us);

  [[nodiscard]] bool due(std::uint64_t tick, std::int64_t now_us) const {
    return now_us >= base_us_ + depth_us_ + start_us(tick);
  }
  [[nodiscard]] std::int64_t depth_us() const { return depth_us_; }

 private:
  [[nodiscard]] std::int64_t start_us(std::uint64_t tick) const {
    return static_cast<std::int64_t>(tick * 1'000'000 / tick_rate_);
  }

  std::uint32_t tick_rate_ = 60;
  std::array<std::int64_t, k_window> offsets_{};  ///< arrival against the tick's own time
  std::size_t count_ = 0;
  std::int64_t base_us_ = INT64_MIN / 4;
  std::int64_t depth_us_ = 0;
};

}  // namespace lockstone::net
