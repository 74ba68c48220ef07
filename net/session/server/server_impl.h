// The inside of net::Server: the data that its parts share, and the parts in the order in which
// they are built on each other.
#pragma once

#include <cstdint>

#include <lockstone/net/server.h>

#include "net/session/server/admission.h"
#include "net/session/server/departures.h"
#include "net/session/server/desync_cases.h"
#include "net/session/server/desync_response.h"
#include "net/session/server/dumps.h"
#include "net/session/server/entry_states.h"
#include "net/session/server/input_intake.h"
#include "net/session/server/laggards.h"
#include "net/session/server/match_end.h"
#include "net/session/server/player_entry.h"
#include "net/session/server/server_data.h"
#include "net/session/server/spectators.h"
#include "net/session/server/state_comparison.h"
#include "net/session/server/tick_confirmer.h"
#include "net/session/server/tick_sender.h"

namespace lockstone::net {

/// An update receives, calls the parts in a fixed order, and sends.
struct Server::Impl {
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
  TickSender sender;
  Spectators spectators;
  Admission admission;

  // Judging states.
  DesyncResponse response;
  StateComparison comparison;

  // Ticks.
  InputIntake inputs;
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
