// A convex shape moved along a line against another.
#pragma once

#include "core/geometry/distance/gjk/gjk.h"

namespace lockstone {

/// Where a moved shape first meets one at rest.
struct ShapeCastHit {
  bool hit = false;
  bool overlapping = false;  ///< at the start: then the fraction is 0
  Unit fraction{};           ///< of the translation, 0 … 1, rounded down
  Vec3<Unit> normal{};       ///< from A to B, world axes; at a start that overlaps, the way out
  Vec3<Length> point_a{};    ///< on A's surface, from A's centre
  Vec3<Length> point_b{};    ///< on B's surface, from B's centre where it is then
};

/// Moves B from `offset` (centre of B − centre of A, world axes) by `translation`. The shapes are
/// those of `distance`, half-spaces left out, and its bound on the offset holds along the way.
///
/// No contact before `fraction`, up to 2 µm; there the distance is at most 1 µm plus the length of
/// a step of the fraction (2^-30 of the translation). A shape that starts within that distance hits
/// at 0 if it approaches, and not if it leaves or slides along. A miss means that a plane separates
/// the shapes for the rest of the way, or up to `limit`: a later contact is a miss, or a hit beyond
/// it.
///
/// Conservative advancement (Mirtich, Impulse-based dynamic simulation of rigid body
/// systems, 2.3.2; Van den Bergen, Ray casting against general convex objects with application to
/// continuous collision detection, 2004, for the use of the supporting plane): the plane of the
/// closest points bounds how far B may move. The distance is convex along the way, so the steps are
/// Newton's on a convex function: a graze at least halves the rest each time. After 96 steps, which
/// no test has needed, the place reached stands as the hit.
[[nodiscard]] ShapeCastHit cast_shape(const PosedShape& a, const PosedShape& b,
                                      const Vec3<Length>& offset, const Vec3<Length>& translation,
                                      Unit limit = Unit::from_integer(1));

}  // namespace lockstone
