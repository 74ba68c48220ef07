// How often a server refuses requests for connections whose sender it does not know.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "net/security/rate_limit.h"
#include "net/transport/udp/datagram_source.h"

namespace lockstone::net {

class RefusalLimit {
 public:
  static constexpr std::uint32_t k_per_second = 20;        ///< to all
  static constexpr std::uint32_t k_source_per_second = 2;  ///< to one site
  static constexpr std::uint32_t k_source_burst = 4;

  /// False if this site (from_one_site), or all together, were refused too often.
  [[nodiscard]] bool take(const DatagramSource& source, std::int64_t now_us) {
    return sources_[place_of(source)].take(now_us, 1) && all_.take(now_us, 1);
  }

 private:
  static constexpr unsigned k_place_bits = 8;

  // Sites that meet in a place share its limit.
  static std::size_t place_of(const DatagramSource& source) {
    return (site_number(source) * 0x9e3779b97f4a7c15U) >> (64 - k_place_bits);
  }

  static std::array<RateLimit, 1U << k_place_bits> all_full() {
    std::array<RateLimit, 1U << k_place_bits> limits;
    limits.fill(RateLimit(k_source_per_second, k_source_burst));
    return limits;
  }

  RateLimit all_{k_per_second, k_per_second};
  std::array<RateLimit, 1U << k_place_bits> sources_ = all_full();
};

}  // namespace lockstone::net
