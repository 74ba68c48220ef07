// The toy simulation as a game of the simulated network, and its broken copies.
#pragma once

#include "tools/simnet/match.h"

namespace lockstone::simnet {

enum class Defect : std::uint8_t {
  none,
  flipped_bit,  ///< one bit of one client's live state changes, once
  unsaved,      ///< every peer's snapshots leave out one field
};

/// A toy match for a seed. With flipped_bit, `control` is filled in: where and when it flips.
[[nodiscard]] Game make_toy_game(std::uint64_t seed, std::size_t clients, std::uint64_t ticks,
                                 Defect defect, std::optional<Control>& control);

}  // namespace lockstone::simnet
