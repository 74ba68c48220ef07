// A pair of bodies.
#pragma once

#include <compare>
#include <cstdint>

namespace lockstone {

/// Two bodies whose bounds overlap, in the order of `is_in_order`. One of them can move.
struct Pair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;

  friend constexpr auto operator<=>(const Pair&, const Pair&) = default;
};

/// A body that leads comes before one that does not; of two others the lower index comes first.
[[nodiscard]] constexpr bool is_in_order(const Pair& pair, bool a_leads, bool b_leads) {
  return a_leads == b_leads ? pair.a < pair.b : a_leads;
}

}  // namespace lockstone
