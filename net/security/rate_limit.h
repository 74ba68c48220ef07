// How much of something may come in a second.
#pragma once

#include <algorithm>
#include <cstdint>

namespace lockstone::net {

/// A token bucket: `per_second` units on average, `burst` at once.
class RateLimit {
 public:
  /// 0 per second: no limit.
  explicit RateLimit(std::uint32_t per_second = 0, std::uint32_t burst = 0)
      : per_second_(per_second), room_(std::uint64_t{burst} * k_second_us), full_(room_) {}

  /// False, and nothing is taken, if that would be too much. Time never runs backwards.
  [[nodiscard]] bool take(std::int64_t now_us, std::uint32_t units) {
    if (per_second_ == 0) return true;
    const auto passed_us = static_cast<std::uint64_t>(std::max<std::int64_t>(now_us - last_us_, 0));
    last_us_ = now_us;
    // Longer than this fills any bucket.
    room_ = std::min(full_, room_ + std::min(passed_us, k_longest_us) * per_second_);
    const std::uint64_t cost = std::uint64_t{units} * k_second_us;
    if (cost > room_) return false;
    room_ -= cost;
    return true;
  }

 private:
  static constexpr std::uint64_t k_second_us = 1'000'000;
  static constexpr std::uint64_t k_longest_us = std::uint64_t{1} << 30;

  std::uint32_t per_second_;
  std::uint64_t room_;  ///< in millionths of a unit
  std::uint64_t full_;
  std::int64_t last_us_ = 0;
};

}  // namespace lockstone::net
