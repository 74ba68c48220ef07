// The limits of one peer, and when it has passed them too often.
#pragma once

#include <cstdint>

#include "net/security/rate_limit.h"

namespace lockstone::net {

class FloodWatch {
 public:
  static constexpr std::uint32_t k_burst_seconds = 10;
  static constexpr std::uint32_t k_patience_seconds = 2;   ///< this much too much …
  static constexpr std::int64_t k_window_us = 10'000'000;  ///< … within this is a flood

  FloodWatch() = default;
  FloodWatch(std::uint32_t packets_per_second, std::uint32_t bytes_per_second)
      : packets_(packets_per_second, times(packets_per_second, k_burst_seconds)),
        bytes_(bytes_per_second, times(bytes_per_second, k_burst_seconds)),
        patience_(times(packets_per_second, k_patience_seconds)) {}

  /// False if this one is too much.
  [[nodiscard]] bool admit(std::int64_t now_us, std::uint32_t bytes) {
    if (packets_.take(now_us, 1) && bytes_.take(now_us, bytes)) return true;
    if (now_us - window_began_us_ > k_window_us) {
      window_began_us_ = now_us;
      excess_ = 0;
    }
    ++excess_;
    return false;
  }

  [[nodiscard]] bool flooding() const { return excess_ > patience_; }

 private:
  static std::uint32_t times(std::uint32_t rate, std::uint32_t seconds) {
    constexpr std::uint32_t k_most = 0xffffffff;
    return rate > k_most / seconds ? k_most : rate * seconds;
  }

  RateLimit packets_;
  RateLimit bytes_;
  std::uint32_t patience_ = 0;
  std::uint32_t excess_ = 0;
  std::int64_t window_began_us_ = 0;
};

}  // namespace lockstone::net
