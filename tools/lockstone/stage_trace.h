// What the stages of one tick left behind, to name the first in which two runs part.
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

/// Steps once; answers the stages in their order, between `commands`, what they began with, and
/// `rules`, what the game made of them.
/// Empty for a simulation without a world.
[[nodiscard]] StageTrace step_traced(Simulation& simulation, std::span<const PlayerInput> inputs);

/// The first stage with another digest; empty when there is none, or one of the two is empty.
[[nodiscard]] std::string first_difference(const StageTrace& here, const StageTrace& there);

}  // namespace lockstone::tool
