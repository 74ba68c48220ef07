// Hashes after the stages of one tick, to name the first stage in which two runs diverge.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lockstone/replay/tick_reader.h>
#include <lockstone/simulation.h>
#include <lockstone/tool.h>

namespace lockstone::tool {

struct StageDigest {
  std::string name;
  std::uint64_t digest = 0;
};
using StageTrace = std::vector<StageDigest>;

/// A simulation that traces its own stages, because its world is out of reach.
class SelfTracing {
 public:
  virtual ~SelfTracing() = default;
  [[nodiscard]] virtual StageTrace step_traced(std::span<const PlayerInput> inputs) = 0;
};

/// Steps once; returns the hashes of the stages in their order, between `commands`, the state they
/// began with, and `rules`, the state after the game's own rules. Empty for a simulation without a
/// world.
[[nodiscard]] StageTrace step_traced(const GameDef& game, Simulation& simulation,
                                     std::span<const PlayerInput> inputs);

/// The same for a tick of a log, with its commands before the first stage.
[[nodiscard]] inline StageTrace step_traced(const GameDef& game, Simulation& simulation,
                                            const replay::TickReader& tick) {
  for (const PlayerCommand& command : tick.commands())
    simulation.command(command);
  return step_traced(game, simulation, tick.inputs());
}

/// The first stage with another digest; empty when there is none, or one of the two is empty.
[[nodiscard]] std::string first_difference(const StageTrace& here, const StageTrace& there);

}  // namespace lockstone::tool
