// When each tick is due: at the tick rate from a tick whose time is set.
#pragma once

#include <cstdint>

namespace lockstone::net {

/// The time of a tick follows from the last one that was set, not from the tick before it: so
/// rounding does not add up.
class TickSchedule {
 public:
  explicit TickSchedule(std::uint32_t tick_rate) : tick_rate_(tick_rate) {}

  /// From now on `tick` is due at `due_us`, and the others by the tick rate from it.
  void rebase(std::uint64_t tick, std::int64_t due_us) {
    tick_ = tick;
    due_us_ = due_us;
  }

  /// The time of any tick, before or after the one that was set.
  [[nodiscard]] std::int64_t due_us(std::uint64_t tick) const {
    const auto ahead = static_cast<std::int64_t>(tick) - static_cast<std::int64_t>(tick_);
    return due_us_ + ahead * 1'000'000 / static_cast<std::int64_t>(tick_rate_);
  }

 private:
  std::uint32_t tick_rate_;
  std::uint64_t tick_ = 0;
  std::int64_t due_us_ = 0;
};

}  // namespace lockstone::net
