#include "net/session/playout_clock.h"

#include <algorithm>

namespace lockstone::net {

void PlayoutClock::arrived(std::uint64_t tick, std::int64_t now_us) {
  offsets_[count_++ % k_window] = now_us - start_us(tick);
  const std::size_t used = std::min(count_, k_window);
  std::array<std::int64_t, k_window> sorted = offsets_;
  // The one that 99 of a hundred do not exceed: the second largest of a full window.
  const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>((used - 1) * 99 / 100);
  std::nth_element(sorted.begin(), nth, sorted.begin() + static_cast<std::ptrdiff_t>(used));
  base_us_ = *std::min_element(sorted.begin(), nth + 1);
  depth_us_ = std::min(*nth - base_us_, k_max_depth_us);
}

}  // namespace lockstone::net
