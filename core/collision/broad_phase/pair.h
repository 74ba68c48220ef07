// A pair of bodies.
#pragma once

#include <compare>
#include <cstdint>

namespace lockstone {

/// Two bodies whose bounds overlap. `a` can move; `b` is static, or can move and has the higher
/// index.
struct Pair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;

  friend constexpr auto operator<=>(const Pair&, const Pair&) = default;
};

}  // namespace lockstone
