// Which counters of packets that may be lost, doubled or overtaken have been seen.
// The sliding window of S. Kent and K. Seo, RFC 4301, appendix A.2, as a ring of bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lockstone::net {

class ReplayWindow {
 public:
  static constexpr std::uint64_t k_size = 256;  ///< older packets than this are refused

  /// The counter whose low 32 bits these are, nearest to the newest seen.
  [[nodiscard]] std::uint64_t expand(std::uint32_t low) const {
    constexpr std::uint64_t k_span = std::uint64_t{1} << 32;
    const std::uint64_t counter = (next_ & ~(k_span - 1)) | low;
    if (counter + k_span / 2 < next_) return counter + k_span;
    if (counter >= next_ + k_span / 2 && counter >= k_span) return counter - k_span;
    return counter;
  }

  /// False if it was marked, or is too old to know.
  [[nodiscard]] bool accepts(std::uint64_t counter) const {
    if (counter >= next_) return true;
    return next_ - counter <= k_size && !bit(counter);
  }

  /// Only for an authentic packet, else anybody could move the window.
  void mark(std::uint64_t counter) {
    if (counter >= next_) forget_until(counter);
    seen_[counter % k_size / 64] |= std::uint64_t{1} << counter % 64;
  }

 private:
  [[nodiscard]] bool bit(std::uint64_t counter) const {
    return (seen_[counter % k_size / 64] >> counter % 64 & 1) != 0;
  }

  void forget_until(std::uint64_t counter) {
    if (counter - next_ >= k_size) seen_ = {};
    for (; counter - next_ < k_size && next_ <= counter; ++next_) {
      seen_[next_ % k_size / 64] &= ~(std::uint64_t{1} << next_ % 64);
    }
    next_ = counter + 1;
  }

  std::uint64_t next_ = 0;  ///< one above the newest marked
  std::array<std::uint64_t, k_size / 64> seen_{};
};

}  // namespace lockstone::net
