// The handshake: from a connection to a seat or a spectator's place, or to a refusal that says why.
#pragma once

#include <cstdint>

#include <lockstone/bytes.h>

#include "net/session/server/data/server_data.h"
#include "net/session/server/entry/player_entry.h"
#include "net/session/server/entry/spectators.h"
#include "net/session/server/leaving/departures.h"

namespace lockstone::net {

/// Judges those who want to take part, and seats them. Messages return false for a packet that
/// breaks the format or comes out of turn.
class Admission {
 public:
  Admission(ServerData& data, Departures& departures, PlayerEntry& entry, Spectators& spectators)
      : data_(data), departures_(departures), entry_(entry), spectators_(spectators) {}

  /// A new connection.
  void accept(ConnectionId connection);

  [[nodiscard]] bool on_hello(Peer& peer, ByteView packet);
  [[nodiscard]] bool on_answer(Peer& peer, ByteView packet);

  /// A client with a token, whose first packet is one of the secure transport, is told that the
  /// session is insecure.
  [[nodiscard]] bool refuse_secure_hello(Peer& peer, ByteView packet);

  /// Begins the match if enough players are seated.
  void try_start();

 private:
  [[nodiscard]] Refusal judge_hello(const Peer& peer, const Hello& hello) const;
  [[nodiscard]] Refusal judge_seats(const Peer& peer) const;
  [[nodiscard]] Refusal judge_info(const SimulationInfo& theirs) const;
  [[nodiscard]] std::uint8_t slot_for(const Peer& peer) const;
  [[nodiscard]] bool is_player_of(const Peer& peer, std::uint8_t slot) const;
  void seat(Peer& peer, std::uint8_t slot);

  ServerData& data_;
  Departures& departures_;
  PlayerEntry& entry_;
  Spectators& spectators_;
  std::uint64_t keys_given_ = 0;
};

}  // namespace lockstone::net
