// Sends confirmed ticks to those who follow the match, again and again until they confirm them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lockstone/bytes.h>

#include "net/session/server/data/server_data.h"

namespace lockstone::net {

/// Fills datagrams with the ticks that a follower lacks. The newest go along always, so that a lost
/// packet delays nothing.
class TickSender {
 public:
  explicit TickSender(ServerData& data) : data_(data) {}

  /// To every player for whom something is due.
  void send_to_players();

  /// To one spectator, now.
  void send_to(Watcher& watcher);

  /// A client's request for ticks that are missing between others. False for a packet that breaks
  /// the format or comes out of turn.
  [[nodiscard]] bool on_resend(const Peer& peer, ByteView packet);

 private:
  [[nodiscard]] std::uint64_t end_for(const Follower& follower) const;
  [[nodiscard]] bool is_due(const Seat& seat) const;
  void send_unconfirmed(Follower& follower, Ticks& message);
  std::uint64_t send_ticks(const Follower& follower, std::uint64_t first_tick, Channel channel,
                           Ticks& message);
  void send_resends(Follower& follower, Ticks& message);

  ServerData& data_;
  std::array<std::byte, k_max_datagram_bytes> coded_{};
};

}  // namespace lockstone::net
