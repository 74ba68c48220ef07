// Hashes after the stages of one tick, to name the first stage in which two runs diverge.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone::tool {

struct StageDigest {
  std::string name;
  std::uint64_t digest = 0;
};
using StageTrace = std::vector<StageDigest>;

/// Steps once; returns the hashes of the stages in their order, between `commands`, the state they
/// began with, and `rules`, the state after the game's own rules. Empty for a simulation without a
/// world.
[[nodiscard]] StageTrace step_traced(Simulation& simulation, std::span<const PlayerInput> inputs);

/// The first stage with another digest; empty when there is none, or one of the two is empty.
[[nodiscard]] std::string first_difference(const StageTrace& here, const StageTrace& there);

}  // namespace lockstone::tool
