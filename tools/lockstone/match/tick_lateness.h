// How punctual the ticks of a hosted match are.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace lockstone::tool {

/// Measures each tick against the most punctual one: on schedule, tick n comes n / tick_rate after
/// tick 0. Buckets are 0.1 ms wide, the last takes all from 100 ms on.
class TickLateness {
 public:
  static constexpr std::int64_t k_bucket_us = 100;

  void note(std::int64_t now_us, std::uint32_t tick_rate) {
    const std::int64_t on_time_us =
        now_us - static_cast<std::int64_t>(ticks_++ * 1'000'000 / tick_rate);
    if (ticks_ == 1) earliest_us_ = on_time_us;
    // A schedule that was moved: the match stood still.
    if (on_time_us - earliest_us_ > k_moved_us) earliest_us_ = on_time_us;
    earliest_us_ = std::min(earliest_us_, on_time_us);
    const std::int64_t late_us = on_time_us - earliest_us_;
    longest_us_ = std::max(longest_us_, late_us);
    ++buckets_[std::min(buckets_.size() - 1, static_cast<std::size_t>(late_us / k_bucket_us))];
  }

  void add(const TickLateness& other) {
    for (std::size_t i = 0; i < buckets_.size(); ++i)
      buckets_[i] += other.buckets_[i];
    ticks_ += other.ticks_;
    longest_us_ = std::max(longest_us_, other.longest_us_);
  }

  [[nodiscard]] std::uint64_t ticks() const { return ticks_; }
  [[nodiscard]] std::int64_t longest_us() const { return longest_us_; }

  /// The upper end of the bucket below which this share of all ticks lies.
  [[nodiscard]] std::int64_t percentile_us(unsigned percent) const {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      below += buckets_[i];
      if (below * 100 >= ticks_ * percent) return static_cast<std::int64_t>(i + 1) * k_bucket_us;
    }
    return longest_us_;
  }

 private:
  static constexpr std::int64_t k_moved_us = 250'000;

  std::uint64_t ticks_ = 0;
  std::int64_t earliest_us_ = 0;
  std::int64_t longest_us_ = 0;
  std::array<std::uint32_t, 1001> buckets_{};
};

}  // namespace lockstone::tool
