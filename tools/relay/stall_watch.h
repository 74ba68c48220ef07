// How evenly ticks come: a player sees gaps as jerks.
#pragma once

#include <algorithm>
#include <cstdint>

namespace lockstone::relay {

inline constexpr std::int64_t k_stall_us = 50'000;  ///< three ticks: seen as a jerk

class StallWatch {
 public:
  /// A tick was stepped at this time.
  void tick(std::int64_t now_us) {
    const std::int64_t gap_us = last_us_ < 0 ? 0 : now_us - last_us_;
    longest_us_ = std::max(longest_us_, gap_us);
    if (gap_us > k_stall_us) stalled_us_ += gap_us - k_tick_us;
    last_us_ = now_us;
  }

  [[nodiscard]] std::int64_t longest_us() const { return longest_us_; }
  /// Beyond one tick, of all pauses above k_stall_us.
  [[nodiscard]] std::int64_t stalled_us() const { return stalled_us_; }

 private:
  static constexpr std::int64_t k_tick_us = 16'667;  // at 60 Hz

  std::int64_t last_us_ = -1;
  std::int64_t longest_us_ = 0;
  std::int64_t stalled_us_ = 0;
};

}  // namespace lockstone::relay
