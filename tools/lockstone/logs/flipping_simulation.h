// The negative control: a simulation that goes wrong by one bit at a given tick.
#pragma once

#include <memory>

#include <lockstone/simulation.h>
#include <lockstone/world.h>

namespace lockstone::tool {

/// `inner`, but for one bit of one body's velocity, which changes at the end of tick `tick` (that
/// is in the step from `tick` to `tick` + 1).
[[nodiscard]] std::unique_ptr<Simulation> make_flipping(std::unique_ptr<Simulation> inner,
                                                        std::uint64_t tick);

/// The world of a scene or of the arena, to do it harm; null for another simulation.
[[nodiscard]] World* world_to_disturb(Simulation& simulation);

/// The simulation inside a flipping one, or `simulation` itself.
[[nodiscard]] const Simulation& unwrapped(const Simulation& simulation);

}  // namespace lockstone::tool
