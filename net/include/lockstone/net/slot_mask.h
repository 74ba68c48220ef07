// A set of player slots.
#pragma once

#include <cstddef>
#include <cstdint>

#include <lockstone/simulation.h>

namespace lockstone::net {

/// Bit n stands for slot n.
using SlotMask = std::uint64_t;
static_assert(k_max_players <= 64);

[[nodiscard]] constexpr SlotMask slot_bit(std::size_t slot) {
  return SlotMask{1} << slot;
}

/// False for slots of no player, such as k_spectator_slot.
[[nodiscard]] constexpr bool has_slot(SlotMask mask, std::size_t slot) {
  return slot < k_max_players && (mask & slot_bit(slot)) != 0;
}

}  // namespace lockstone::net
