// Sends the commands of confirmed ticks to those who follow the match, each once and in order.
#pragma once

#include <cstddef>
#include <cstdint>

#include "net/security/rate_limit.h"
#include "net/session/server/data/server_data.h"

namespace lockstone::net {

/// Sends in pieces over the reliable channel, at a pace that leaves room for all other messages.
class CommandSender {
 public:
  explicit CommandSender(ServerData& data)
      : data_(data), pace_(k_bytes_per_second, k_burst_bytes) {}

  /// To everybody who has a state: commands of the ticks that they may see.
  void send();

 private:
  void send_to(Follower& follower, std::uint64_t end_tick);

  // To all followers together.
  static constexpr std::uint32_t k_bytes_per_second = 4 << 20;
  static constexpr std::uint32_t k_burst_bytes = 128 << 10;

  ServerData& data_;
  RateLimit pace_;
  std::size_t first_ = 0;  ///< the slot that comes first
};

}  // namespace lockstone::net
