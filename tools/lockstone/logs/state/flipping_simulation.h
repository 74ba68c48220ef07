// The negative control: a simulation that goes wrong by one bit at a given tick.
#pragma once

#include <memory>

#include <lockstone/simulation.h>
#include <lockstone/tool.h>

namespace lockstone::tool {

/// `inner`, of a game that has a world, but for one bit of one body's position, which changes at
/// the end of tick `tick` (that is in the step from `tick` to `tick` + 1).
[[nodiscard]] std::unique_ptr<Simulation> make_flipping(const GameDef& game,
                                                        std::unique_ptr<Simulation> inner,
                                                        std::uint64_t tick);

/// The simulation inside a flipping one, or `simulation` itself.
[[nodiscard]] const Simulation& unwrapped(const Simulation& simulation);

}  // namespace lockstone::tool
