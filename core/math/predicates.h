// Exact predicates on points with whole coordinates: the sign of a determinant, never an estimate.
//
// Scaling rule. Geometry is brought to a lattice first: differences to a common origin, shifted so
// that they fit k_lattice_bits. Then an orientation fits in int64 and a circumsphere in 128 bits.
// Coordinates that were not scaled are decided in 128 bits; the sign is the same either way.
// (Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates, for
// the determinants; integers need none of its adaptivity.)
#pragma once

#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

using LatticePoint = Vec3<std::int32_t>;

/// Lengths as they are, not scaled.
[[nodiscard]] constexpr LatticePoint lattice_point(const Vec3<Length>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

/// |coordinate| ≤ 2^19 on the lattice, so that |difference| ≤ 2^20.
inline constexpr int k_lattice_bits = 19;

/// The least shift ≥ 0 that brings every |raw| ≤ `extent` within 2^k_lattice_bits.
[[nodiscard]] int lattice_shift(std::uint64_t extent);

/// Each component ⌊(point − origin) / 2^shift⌉. The differences fit in int64, the results in int32.
[[nodiscard]] LatticePoint to_lattice(const Vec3<std::int64_t>& point,
                                      const Vec3<std::int64_t>& origin, int shift);

/// The sign of (b − a) × (c − a) · (d − a): +1 where d is on the side to which the normal of the
/// counter-clockwise triangle abc points, 0 when the four are coplanar. Every input.
[[nodiscard]] int orient3d(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                           const LatticePoint& d);

/// The sign of normal · p − offset. Every input.
[[nodiscard]] int side_of_plane(const LatticePoint& normal, std::int64_t offset,
                                const LatticePoint& p);

/// +1 when p is inside the sphere, 0 when on it, −1 when outside. Every input with radius ≥ 0.
[[nodiscard]] int side_of_sphere(const LatticePoint& centre, std::int64_t radius,
                                 const LatticePoint& p);

/// +1 when e is inside the sphere through a, b, c and d, 0 when on it, −1 when outside; whichever
/// way the tetrahedron is turned. 0 when it is flat. |differences to e| ≤ 2^24.
[[nodiscard]] int side_of_circumsphere(const LatticePoint& a, const LatticePoint& b,
                                       const LatticePoint& c, const LatticePoint& d,
                                       const LatticePoint& e);

/// +1 when p is inside the triangle, 0 when on its boundary, −1 when elsewhere or out of its plane.
/// A flat triangle is all boundary. Every input.
[[nodiscard]] int point_in_triangle(const LatticePoint& a, const LatticePoint& b,
                                    const LatticePoint& c, const LatticePoint& p);

/// The intersection of two sets of points.
enum class Contact : std::uint8_t {
  none,     ///< nothing
  touch,    ///< a point that is an end or on the boundary of one of them
  cross,    ///< one point, inside both
  overlap,  ///< both lie in one line (two segments) or plane (segment and triangle) and share a
            ///< stretch of positive length
};

/// Of the segments ab and cd, ends included. A segment may be one point. Every input.
[[nodiscard]] Contact segment_segment(const LatticePoint& a, const LatticePoint& b,
                                      const LatticePoint& c, const LatticePoint& d);

/// Of the segment pq and the triangle abc, boundary included. Either may be flat. Every input.
[[nodiscard]] Contact segment_triangle(const LatticePoint& p, const LatticePoint& q,
                                       const LatticePoint& a, const LatticePoint& b,
                                       const LatticePoint& c);

}  // namespace lockstone
