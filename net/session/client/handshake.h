// The client's side of the handshake: Hello, the simulation made of the server's configuration, and
// the seat.
#pragma once

#include <cstdint>

#include <lockstone/bytes.h>

#include "net/session/client/client_commands.h"
#include "net/session/client/client_data.h"
#include "net/session/client/client_end.h"
#include "net/session/client/dump_sender.h"
#include "net/session/client/match_entry.h"
#include "net/session/client/prediction.h"

namespace lockstone::net {

/// Says who the client is, makes its simulation and takes its memory, once. Messages return false
/// for a packet that breaks the format or comes out of turn.
class Handshake {
 public:
  /// The parts of the client that it uses.
  struct Uses {
    Prediction& prediction;
    MatchEntry& entry;
    DumpSender& dump;
    ClientCommands& commands;
    ClientEnd& end;
  };
  Handshake(ClientData& data, const Uses& uses) : data_(data), uses_(uses) {}

  /// A new connection: the configuration is to be offered again.
  void restart() { offered_ = false; }

  void say_hello();
  [[nodiscard]] bool on_offer(ByteView packet);
  [[nodiscard]] bool on_welcome(ByteView packet);

 private:
  [[nodiscard]] bool knows_state(ByteView offered_config) const;
  [[nodiscard]] bool make_simulation(ByteView offered_config);
  void reserve_memory();

  ClientData& data_;
  Uses uses_;
  std::uint64_t config_hash_ = 0;  ///< of the configuration that the simulation was made of
  bool offered_ = false;           ///< the configuration came over this connection
};

}  // namespace lockstone::net
