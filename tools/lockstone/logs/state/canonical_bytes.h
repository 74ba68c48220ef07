// The whole state of a simulation as canonical bytes.
#pragma once

#include <cstddef>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone::tool {

[[nodiscard]] std::vector<std::byte> canonical_bytes(const Simulation& simulation);

}  // namespace lockstone::tool
