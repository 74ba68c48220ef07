// Many simulated matches, each from its own seed, on several threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/simnet/match.h"

namespace lockstone::simnet {

/// The game of a seed, with the control that it is to show, if any.
using GameMaker = std::function<Game(std::uint64_t seed, std::optional<Control>& control)>;

struct BatchOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t seeds = 64;
  std::size_t clients = 4;
  std::uint64_t ticks = 3600;
  FaultMask faults = k_all_faults;
  std::optional<Schedule> schedule;  ///< instead of drawing one
  unsigned threads = 4;
  Lie lie = Lie::none;  ///< of the last client; `policy` decides how it is treated
  net::DesyncPolicy policy = net::DesyncPolicy::resync;
  bool shrink = true;  ///< make the schedule of the first failure short
};

struct BatchFailure {
  std::uint64_t seed = 0;
  std::string what;
  Schedule schedule;
  MatchMode mode;
};

struct BatchTotals {
  std::uint64_t matches = 0;
  std::uint64_t ticks = 0;
  std::uint64_t client_ticks = 0;
  std::uint64_t comparisons = 0;
  std::uint64_t substituted_inputs = 0;
  std::uint64_t resends = 0;
  std::uint64_t refused_packets = 0;
  std::uint64_t kills = 0;
  std::uint64_t entries = 0;
  std::uint64_t too_late = 0;
  std::uint64_t rollbacks = 0;
  std::uint64_t faults = 0;  ///< events of all schedules
  std::size_t peak_bytes = 0;
  std::uint64_t hash = 0;              ///< of all final states, in the order of seeds
  std::vector<BatchFailure> failures;  ///< in the order of seeds
};

/// Called with the matches done, from one thread at a time.
using BatchProgress = std::function<void(std::uint64_t done)>;

[[nodiscard]] BatchTotals run_batch(const BatchOptions& options, const GameMaker& make_game,
                                    const BatchProgress& progress = {});

}  // namespace lockstone::simnet
