// One match over the simulated network, from its seed: a server, its clients, faults, an oracle.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/net/server.h>
#include <lockstone/simulation.h>

#include "tools/simnet/lying_transport.h"
#include "tools/simnet/schedule.h"

namespace lockstone::simnet {

/// The game that is played.
struct Game {
  std::vector<std::byte> config;
  SimulationFactory factory;
  /// The simulation of one client that is to go wrong: see Control.
  SimulationFactory faulty_factory;
};

/// A negative control: one client's simulation is the faulty one, and the match must end with a
/// report that says exactly this.
struct Control {
  std::size_t client = 0;
  std::uint64_t tick = 0;
  std::string store;
  std::uint64_t object = 0;
  std::string field;
};

struct MatchSetup {
  std::uint64_t seed = 1;
  std::size_t clients = 4;
  std::uint64_t ticks = 3600;
  Schedule schedule;
  std::optional<Control> control;
  /// The last client lies about its states, from the 100th tick on. It must not keep others from
  /// playing all ticks, whatever becomes of it.
  Lie lie = Lie::none;
  net::DesyncPolicy policy = net::DesyncPolicy::end_match;
};

/// How a match is played; drawn from its seed.
struct MatchMode {
  net::LatePolicy late_policy = net::LatePolicy::deadline;
  net::Pacing pacing = net::Pacing::real_time;
  bool authoritative = true;
  std::uint8_t input_delay_ticks = 4;
  std::size_t late_clients = 0;  ///< this many come when the match runs
  std::uint32_t late_ms = 0;
  std::size_t spectators = 0;
  std::uint32_t spectator_delay_ticks = 0;
  std::uint8_t prediction_ticks = 0;  ///< of every other client; 0: lockstep
  bool sync_test = false;
};
[[nodiscard]] MatchMode draw_mode(std::uint64_t seed, std::size_t clients, std::uint32_t heal_ms);
/// `deadline, authoritative, input delay 4`.
[[nodiscard]] std::string to_text(const MatchMode& mode);

struct MatchOutcome {
  std::string failure;  ///< empty: all is as it must be
  MatchMode mode;
  std::uint64_t ticks = 0;         ///< confirmed by the server
  std::uint64_t client_ticks = 0;  ///< stepped by all clients together
  std::uint64_t comparisons = 0;   ///< of a peer's state with the correct one
  std::uint64_t last_hash = 0;
  std::uint64_t substituted_inputs = 0;
  std::uint64_t resends = 0;
  std::uint64_t refused_packets = 0;  ///< damaged or forged
  std::uint64_t kills = 0;
  std::uint64_t entries = 0;   ///< into a running match: late, or back
  std::uint64_t too_late = 0;  ///< cut off or on the way in when a fast match was over
  std::uint64_t rollbacks = 0;
  std::uint64_t virtual_ms = 0;
  std::size_t peak_bytes = 0;  ///< on the way, at once
};

/// The same setup gives the same outcome.
[[nodiscard]] MatchOutcome run_match(const Game& game, const MatchSetup& setup);

/// When all faults must be over in a match of this many ticks at `tick_rate`, from its start.
[[nodiscard]] std::uint32_t heal_ms(std::uint64_t ticks, std::uint16_t tick_rate);

}  // namespace lockstone::simnet
