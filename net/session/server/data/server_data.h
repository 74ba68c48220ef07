// The data of a server that its parts share: how it was set up, where the match stands, who takes
// part, and the records of the last ticks. Parts refer to it; it knows none of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include <lockstone/net/server.h>
#include <lockstone/net/wire.h>

#include "net/session/hash_judge.h"
#include "net/session/offender_list.h"
#include "net/session/parts_judge.h"
#include "net/session/server/data/peers.h"
#include "net/session/server/data/roster.h"
#include "net/session/server/data/tick_schedule.h"
#include "net/session/tick_ring.h"

namespace lockstone::net {

/// How far apart the states are that a delayed spectator may begin from.
[[nodiscard]] inline std::uint32_t keyframe_ticks_of(const ServerConfig& config) {
  return std::max<std::uint32_t>(60, config.spectator_delay_ticks / 8);
}

/// How far the match is.
struct MatchStatus {
  ServerState state = ServerState::lobby;
  FinishReason finish_reason = FinishReason::completed;
  std::int64_t now_us = 0;
  std::int64_t state_since_us = 0;
  std::uint64_t confirmed = 0;         ///< the inputs of ticks 0 … confirmed - 1 are final
  std::uint64_t end_tick = 0;          ///< the match has ticks below
  SlotMask waiting = 0;                ///< bit n: the next tick waits for slot n
  std::int64_t waiting_since_us = 0;   ///< since then, if it waits for any
  bool paused = false;                 ///< no tick is confirmed
  std::int64_t expected_until_us = 0;  ///< resumed: so long somebody may come back

  void enter(ServerState next) {
    state = next;
    state_since_us = now_us;
  }
  /// Running, or waiting for the last hashes.
  [[nodiscard]] bool is_played() const {
    return state == ServerState::running || state == ServerState::finishing;
  }
};

struct ServerData {
  ServerData(const ServerConfig& server_config, const ServerParts& server_parts);

  /// The newest tick that spectators may see, plus one. After the end there is nothing left to
  /// hide.
  [[nodiscard]] std::uint64_t visible_ticks() const;

  /// The simulation that can name parts and fields of states: the server's own, or the describer;
  /// may be null.
  [[nodiscard]] const Simulation* describer() const {
    return parts.simulation == nullptr ? parts.describer : parts.simulation;
  }
  [[nodiscard]] bool simulates() const { return parts.simulation != nullptr; }

  // As it was made.
  const ServerConfig config;
  const ServerParts parts;
  ServerObserver silent_observer;
  ServerObserver* const observer;
  const SimulationInfo info;
  const TickShape shape;
  const std::int64_t tick_us;

  // The match.
  MatchStatus match;
  TickSchedule schedule;
  TickRing records;    ///< inputs of the last confirmed ticks
  TickRing snapshots;  ///< canonical states after the last ticks, where the server simulates

  TickCommands commands;       ///< of the last confirmed ticks
  CommandBuffer own_commands;  ///< the server's, which wait for their tick

  // Those who take part.
  Peers peers;
  Roster roster;

  // The judgement of their states.
  HashJudge judge;
  PartsJudge parts_judge;
  OffenderList offenders;
  ServerCounters counters;
};

/// The counters of a slot's player. `slot` is below the player count.
[[nodiscard]] PlayerStats player_stats(const ServerData& data, std::uint8_t slot);
[[nodiscard]] ConnectionCounts connection_counts(const ServerData& data);

/// The hash of the state after the last confirmed tick, if it is known.
[[nodiscard]] std::optional<std::uint64_t> final_hash(const ServerData& data);

/// Tells a peer that was just admitted the names of the players in all seats.
void tell_names(ServerData& data, const Peer& peer);

/// The greeting of a client that is admitted to `slot`.
[[nodiscard]] Welcome welcome_of(const ServerData& data, std::uint8_t slot, Entry way);

}  // namespace lockstone::net
