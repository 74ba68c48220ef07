// Which bodies meet, and how the world looks for them.
#pragma once

#include <cstdint>
#include <string_view>

namespace lockstone {

/// How a world finds the pairs of bodies whose bounds overlap. A choice of speed alone: both find
/// the same pairs in the same order.
enum class BroadPhaseKind : std::uint8_t {
  tree = 0,             ///< bounding-volume trees, of use to queries too
  sweep_and_prune = 1,  ///< a list sorted along one axis; often faster when all is in flight
};
[[nodiscard]] std::string_view to_string(BroadPhaseKind kind);

/// Which bodies meet. With an equal non-zero group the sign decides: positive always, negative
/// never. Else both must find the other's category in their mask.
struct CollisionFilter {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xffffffff;
  std::int32_t group = 0;

  friend constexpr bool operator==(const CollisionFilter&, const CollisionFilter&) = default;
};

[[nodiscard]] constexpr bool should_collide(const CollisionFilter& a, const CollisionFilter& b) {
  if (a.group != 0 && a.group == b.group) return a.group > 0;
  return (a.mask & b.category) != 0 && (b.mask & a.category) != 0;
}

}  // namespace lockstone
