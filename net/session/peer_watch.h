// A session's record of its peer: life signs and bad packets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lockstone::net {

/// After as long a silence a peer says that it is still there.
inline constexpr std::int64_t k_keepalive_us = 250'000;

class PeerWatch {
 public:
  static constexpr std::size_t k_malformed_limit = 3;
  static constexpr std::int64_t k_malformed_span_us = 10'000'000;

  void heard(std::int64_t now_us) {
    last_heard_us_ = now_us;
    warned_ = false;
  }

  [[nodiscard]] std::int64_t silent_us(std::int64_t now_us) const {
    return now_us - last_heard_us_;
  }

  /// True once per silence, when it exceeds `limit_us`.
  bool warn(std::int64_t now_us, std::int64_t limit_us) {
    if (warned_ || silent_us(now_us) <= limit_us) return false;
    warned_ = true;
    return true;
  }

  /// Counts a bad packet. True when the limit is reached within the span.
  bool malformed(std::int64_t now_us) {
    malformed_us_[malformed_count_++ % k_malformed_limit] = now_us;
    if (malformed_count_ < k_malformed_limit) return false;
    // The place that the next one would take holds the oldest of the last three.
    const std::int64_t first_us = malformed_us_[malformed_count_ % k_malformed_limit];
    return now_us - first_us <= k_malformed_span_us;
  }

  [[nodiscard]] std::uint64_t malformed_count() const { return malformed_count_; }

 private:
  std::int64_t last_heard_us_ = 0;
  bool warned_ = false;
  std::array<std::int64_t, k_malformed_limit> malformed_us_{};
  std::uint64_t malformed_count_ = 0;
};

}  // namespace lockstone::net
