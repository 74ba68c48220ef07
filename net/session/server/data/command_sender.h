// Sends the commands of confirmed ticks to those who follow the match, each once and in order.
#pragma once

#include <cstdint>

#include "net/session/server/data/server_data.h"

namespace lockstone::net {

/// Sends in pieces over the reliable channel, a few an update to each follower.
class CommandSender {
 public:
  explicit CommandSender(ServerData& data) : data_(data) {}

  /// To everybody who has a state: commands of the ticks that they may see.
  void send();

 private:
  void send_to(Follower& follower, std::uint64_t end_tick);

  ServerData& data_;
};

}  // namespace lockstone::net
