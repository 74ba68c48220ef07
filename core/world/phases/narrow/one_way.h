// One-way bodies: whether the contacts of a pair hold, or its bodies pass each other.
#pragma once

#include <span>

#include "core/collision/narrow_phase/collide_bodies.h"
#include "core/dynamics/state/one_way_bits.h"
#include "core/geometry/distance/motion/separating_motion.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/narrow/narrow_phase.h"

namespace lockstone {

[[nodiscard]] inline bool is_one_way_pair(const WorldData& world, const Pair& pair) {
  return is_one_way(world.bodies[pair.a]) || is_one_way(world.bodies[pair.b]);
}

/// A passing body is stopped once it is in front and no deeper than this.
inline constexpr Displacement k_one_way_depth = Displacement::from_ratio(1, 100);

/// Decides for a pair of which one body, or both, is one-way. `before`: its records a tick ago. Of
/// `parts` those stay that hold: their normals lie within the tolerance. Returns whether the bodies
/// pass each other instead; then no part holds.
///
/// A pair that held goes on as long as a part holds. One that passes does so until it meets no
/// more, or is in front by k_one_way_depth. A pair that meets for the first time holds if it is in
/// front and no deeper than half the thickness of the moving body, where continuous collision
/// leaves it.
[[nodiscard]] bool is_passing(const WorldData& world, const Pair& pair,
                              std::span<const ContactRecord> before, PartContacts& parts);

/// Whether a unit normal from A to B lies within the tolerance of each one-way body of the pair.
[[nodiscard]] bool is_in_front(const WorldData& world, const Pair& pair, const Vec3<Unit>& normal);

/// Whether a body that would run into another after a fraction of their ways goes on, because the
/// other is one-way and lets it pass.
[[nodiscard]] bool passes_on_way(const WorldData& world, NarrowPhase& narrow, const Pair& pair,
                                 const Sweep& way_a, const Sweep& way_b, Unit fraction);

}  // namespace lockstone
