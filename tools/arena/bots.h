// Players without a human: inputs from seed, slot, tick and the bot's view of its own copy of the
// game. Integers only and no memory: the same view gives the same input anywhere.
#pragma once

#include <cstdint>

#include "tools/arena/arena.h"
#include "tools/arena/input.h"

namespace lockstone::arena {

[[nodiscard]] Input bot_input(const Arena& arena, std::uint64_t seed, std::size_t slot);

}  // namespace lockstone::arena
