// The least depth along the directions of a ring: those at one angle from an axis.
#pragma once

#include "core/geometry/distance/gjk/gjk.h"

namespace lockstone::geometry {

/// The directions flat · (u cos φ + v sin φ) + rise · axis, for every φ.
struct Ring {
  Vec3<Unit> axis{};
  Unit rise{};
  Unit flat = Unit::from_integer(1);
};

/// Something small in the middle of a large drum is about as deep in it along every direction
/// across the side, and each of its edges may make a valley of its own: neither descents nor
/// polytopes tell these valleys apart. Along the ring of the side's normals the depth is a function
/// of one angle. Of every angle that was looked at, value, slope and curvature are known: where
/// a vertex of each core is the farthest, the depth is a sine, from which others only stand out,
/// and the curvature of rims is added to it. So two neighbours bound the depth between them from
/// below. The gap with the least bound is divided there until no bound is less than the least
/// value by `tolerance`. (J. Kelley, The cutting-plane method for solving convex programs, 1960,
/// with sines in place of lines.)
///
/// Returns the best direction if its depth is less than `most`; else one of those looked at.
/// `offset` is that from A's centre to B's; `query` has the lattice.
[[nodiscard]] Vec3<Unit> least_on_ring(const GapQuery& query, const RawVec& offset,
                                       const Ring& ring, Fine most, Fine tolerance);

}  // namespace lockstone::geometry
