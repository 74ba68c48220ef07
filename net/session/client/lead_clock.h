// The tick that a client has reached by its own clock, so that a late packet from the server does
// not make this player's inputs late as well.
#pragma once

#include <cstdint>

namespace lockstone::net {

/// A clock that runs at the tick rate, trimmed to follow the server's.
class LeadClock {
 public:
  /// `tick` begins now.
  void restart(std::uint64_t tick, std::int64_t now_us) {
    clock_us_ = 0;
    set_us_ = now_us;
    origin_us_ = 0;
    tick_ = tick;
  }

  /// Moves the clock on to `now_us`, `trim_ppm` faster than real time.
  void advance(std::int64_t now_us, std::int32_t trim_ppm) {
    const std::int64_t passed_us = now_us - set_us_;
    set_us_ = now_us;
    clock_us_ += passed_us + passed_us * trim_ppm / 1'000'000;
  }

  [[nodiscard]] std::uint64_t tick(std::uint32_t tick_rate) const {
    const auto elapsed_us = static_cast<std::uint64_t>(clock_us_ - origin_us_);
    return tick_ + elapsed_us * tick_rate / 1'000'000;
  }

  /// The match stalls: `tick` begins now, by this clock.
  void set_tick(std::uint64_t tick) {
    origin_us_ = clock_us_;
    tick_ = tick;
  }

 private:
  std::int64_t clock_us_ = 0;   ///< the time by the trimmed clock, from any origin
  std::int64_t set_us_ = 0;     ///< when it was last moved on
  std::int64_t origin_us_ = 0;  ///< at this time by it …
  std::uint64_t tick_ = 0;      ///< … this tick began
};

}  // namespace lockstone::net
