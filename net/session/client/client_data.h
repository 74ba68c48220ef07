// The data of a client that its parts share: how it was made, where it stands, its seat, its
// simulation and the ticks of the match. Parts refer to it; it knows none of them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include <lockstone/net/client.h>
#include <lockstone/net/wire.h>

#include "net/session/client/own_inputs.h"
#include "net/session/client/server_connection.h"
#include "net/session/client/tick_buffer.h"
#include "net/session/command_buffer.h"
#include "net/session/lead_control.h"
#include "net/session/playout_clock.h"
#include "net/session/tick_ring.h"

namespace lockstone::net {

/// The state of the connection and of the match, as the client's owner sees them.
struct ClientStatus {
  ClientState state = ClientState::connecting;
  ClientFailure failure = ClientFailure::none;
  LeaveReason leave_reason = LeaveReason::left;
  FinishReason finish_reason = FinishReason::completed;
  Refusal refusal;
  std::int64_t now_us = 0;
  bool paused = false;
  bool over = false;     ///< the match is: nothing is kept back
  SlotMask waiting = 0;  ///< bit n: the match waits for slot n

  /// Neither finished nor refused nor failed.
  [[nodiscard]] bool active() const { return state < ClientState::finished; }
};

/// The simulation that was made of the server's configuration.
struct ClientGame {
  std::unique_ptr<Simulation> simulation;
  SimulationInfo info;
  TickShape shape;
  std::int64_t tick_us = 0;
};

/// The client's place in the match.
struct ClientPlace {
  static constexpr std::uint64_t k_never = std::numeric_limits<std::uint64_t>::max();

  Welcome welcome;
  bool seated = false;
  std::uint64_t rejoin_key = 0;
  std::uint64_t active_tick = k_never;  ///< own inputs count from here on
  SlotMask present_mask = 0;            ///< at the start

  [[nodiscard]] bool spectates() const { return welcome.slot == k_spectator_slot; }
  [[nodiscard]] bool plays() const { return active_tick != k_never; }
};

/// The confirmed ticks that were stepped, and the states after them.
struct ClientProgress {
  std::uint64_t stepped = 0;     ///< ticks below are stepped
  std::uint64_t state_hash = 0;  ///< of the state after them; 0 at first
  HashRing hashes;
  std::uint64_t hashes_acknowledged = 0;  ///< hashes below need not be sent
  Parts state_parts;   ///< of the newest state that has some; predicting, it may be a guess
  TickRing snapshots;  ///< canonical states after the last ticks, unless the client predicts
  bool news = false;   ///< something to say since the last Inputs
};

struct ClientData {
  ClientData(const ClientConfig& client_config, ClientParts client_parts);

  [[nodiscard]] bool predicts() const { return config.prediction_ticks > 0 && !place.spectates(); }

  const ClientConfig config;
  const ClientParts parts;
  ClientObserver silent_observer;
  ClientObserver* const observer;

  ServerConnection server;
  ClientStatus status;
  ClientPlace place;
  ClientGame game;
  ClientProgress progress;
  TickBuffer ticks;
  TickCommands commands;  ///< of ticks that come next
  OwnInputs inputs;
  PlayoutClock playout;
  LeadControl lead;
  std::array<PlayerName, k_max_players> names;  ///< by slot, as far as the server told them
  ClientStats stats;                            ///< without those that current_stats adds
};

/// The record of `tick` is here, and so are the tick's commands.
[[nodiscard]] bool is_complete(const ClientData& data, std::uint64_t tick);

/// Notes the hashes of parts of the simulation's state, if they are due. Called after every step.
void note_parts(ClientData& data);

/// The counters until now, or, of a client that is no longer active, until its end.
[[nodiscard]] ClientStats current_stats(const ClientData& data);

}  // namespace lockstone::net
