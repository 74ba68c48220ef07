// How often each seat of a match may be taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/net/transport.h>

#include "net/security/rate_limit.h"

namespace lockstone::net {

/// Each entry costs the session a seating, and maybe a snapshot. Only proven ones count, so nobody
/// else uses up a player's. Of more seats than fit, the least recent is forgotten. Allocates when
/// made only.
class EntryLimits {
 public:
  // A player whose connection breaks calls again after 0.25 s, and each time after twice as long.
  static constexpr std::uint32_t k_per_second = 1;
  static constexpr std::uint32_t k_burst = 10;

  /// `capacity` is above 0.
  explicit EntryLimits(std::size_t capacity) : seats_(capacity) {}

  /// Counts an entry; false if the player's seat was taken too often.
  [[nodiscard]] bool take(const PeerIdentity& identity, std::int64_t now_us) {
    Seat* place = &seats_.front();
    for (Seat& one : seats_) {
      if (one.last_us >= 0 && one.identity == identity) {
        one.last_us = now_us;
        return one.limit.take(now_us, 1);
      }
      if (one.last_us < place->last_us) place = &one;
    }
    *place = {identity, now_us, RateLimit(k_per_second, k_burst)};
    return place->limit.take(now_us, 1);
  }

 private:
  struct Seat {
    PeerIdentity identity;
    std::int64_t last_us = -1;  ///< below 0: this place is free
    RateLimit limit;
  };
  std::vector<Seat> seats_;
};

}  // namespace lockstone::net
