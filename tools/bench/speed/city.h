// A world in which everything sleeps.
#pragma once

#include <cstdint>

#include <lockstone/world.h>

namespace lockstone::bench {

/// Stepped until all of them sleep, in houses of five on the ground.
[[nodiscard]] World make_city(BroadPhaseKind broad_phase, std::uint32_t bodies);

}  // namespace lockstone::bench
