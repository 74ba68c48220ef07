// The inside of net::Server: the data that its parts share, and the parts in the order in which
// they are built on each other.
#pragma once

#include <cstdint>

#include <lockstone/net/server.h>

#include "net/session/server/comparison/desync_response.h"
#include "net/session/server/comparison/state_comparison.h"
#include "net/session/server/data/command_sender.h"
#include "net/session/server/data/server_data.h"
#include "net/session/server/data/tick_sender.h"
#include "net/session/server/desync/desync_cases.h"
#include "net/session/server/desync/dumps.h"
#include "net/session/server/entry/admission.h"
#include "net/session/server/entry/entry_states.h"
#include "net/session/server/entry/player_entry.h"
#include "net/session/server/entry/spectators.h"
#include "net/session/server/leaving/departures.h"
#include "net/session/server/leaving/match_end.h"
#include "net/session/server/ticks/command_intake.h"
#include "net/session/server/ticks/input_intake.h"
#include "net/session/server/ticks/laggards.h"
#include "net/session/server/ticks/tick_confirmer.h"

namespace lockstone::net {

/// An update receives, calls the parts in a fixed order, and sends.
struct Server::Impl {
  struct Sending {
    explicit Sending(ServerData& data) : ticks(data), commands(data) {}
    TickSender ticks;
    CommandSender commands;
  };
  struct Taking {
    explicit Taking(ServerData& data) : inputs(data), commands(data) {}
    InputIntake inputs;
    CommandIntake commands;
  };

  Impl(const ServerConfig& config, const ServerParts& parts);

  void update(std::int64_t now_us);
  void stop();
  void set_paused(bool paused);

  ServerData data;

  // Desyncs, and the end.
  DumpRequests dumps;
  DesyncCases cases;
  MatchEnd end;
  Departures departures;

  // Entering a match.
  EntryStates states;
  PlayerEntry entry;
  Sending sending;
  Spectators spectators;
  Admission admission;

  // Judging states.
  DesyncResponse response;
  StateComparison comparison;

  // Ticks.
  Taking taking;
  Laggards laggards;
  TickConfirmer confirmer;

 private:
  void receive();
  void receive_packet(Peer& peer, ByteView packet);
  [[nodiscard]] bool dispatch(Peer& peer, ByteView packet);
  [[nodiscard]] bool on_dump(const Peer& peer, ByteView packet);
  [[nodiscard]] bool on_ask(const Peer& peer, ByteView packet);
  [[nodiscard]] bool on_bye(Peer& peer, ByteView packet);
};

}  // namespace lockstone::net
