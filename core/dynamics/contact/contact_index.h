// The two numbers of a contact in a tick's solver, one type each, so that they cannot be mixed up.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

/// Number of a contact among those that the solver has in a tick, in the order of the records.
struct ContactId {
  std::uint32_t value = 0;

  friend constexpr auto operator<=>(const ContactId&, const ContactId&) = default;
};

/// Place of a contact's words: its lane, counted over the lanes of all blocks.
struct ContactLane {
  std::uint32_t value = 0;

  [[nodiscard]] constexpr std::size_t block() const { return value / lanes::k_block_lanes; }
  [[nodiscard]] constexpr std::size_t lane() const { return value % lanes::k_block_lanes; }

  friend constexpr auto operator<=>(const ContactLane&, const ContactLane&) = default;
};

}  // namespace lockstone
