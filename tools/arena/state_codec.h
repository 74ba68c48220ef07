// The game's state as bytes, and the first difference between two of them.
#pragma once

#include <cstddef>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/simulation.h>
#include <lockstone/status.h>

#include "tools/arena/state.h"

namespace lockstone::arena {

/// Appends the state of `players` slots, little-endian.
void encode_state(const GameState& state, std::size_t players, ByteWriter& writer);

/// Reads the bytes of encode_state. truncated, or malformed for values that no game reaches.
Result<GameState> decode_state(std::size_t players, ByteReader& reader);

/// The first field that differs, in canonical order.
[[nodiscard]] StateDifference first_difference(const GameState& here, const GameState& there,
                                               std::size_t players);

}  // namespace lockstone::arena
