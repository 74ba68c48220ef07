// The treatment of a player whose state differs.
//
// A player that is found wrong is out from that moment on, and the match goes on without it while
// the snapshots of the first bad tick are fetched. Only where nobody can tell who is right, or the
// policy is to end the match, does the match stand still. The snapshots are the ones that were kept
// when the tick was stepped: stepping again from an older one would not bring back a bit that
// flipped in memory.
#pragma once

#include <cstdint>
#include <string>

#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/desync_cases.h"
#include "net/session/server/desync/dumps.h"
#include "net/session/server/entry/entry_states.h"
#include "net/session/server/entry/player_entry.h"
#include "net/session/server/leaving/departures.h"
#include "net/session/server/leaving/match_end.h"

namespace lockstone::net {

/// Opens a case for each mismatch, and when its snapshots are here, reports it and carries out the
/// desync policy.
class DesyncResponse {
 public:
  /// The parts of the server that it uses.
  struct Uses {
    DumpRequests& dumps;
    DesyncCases& cases;
    EntryStates& states;
    PlayerEntry& entry;
    Departures& departures;
    MatchEnd& end;
  };
  DesyncResponse(ServerData& data, const Uses& uses) : data_(data), uses_(uses) {}

  /// `part` names the part of the state that differs, if the 128-bit hashes found it.
  void open(const Mismatch& mismatch, const std::string& part);

  /// Closes the cases whose snapshots are here or will not come.
  void advance();

 private:
  void condemn(std::uint8_t slot);
  void ask_reference();
  void close_first();
  [[nodiscard]] bool server_is_wrong(const Mismatch& mismatch);

  ServerData& data_;
  Uses uses_;
};

}  // namespace lockstone::net
