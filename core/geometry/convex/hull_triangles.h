// The hull of points as triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/hull.h>

namespace lockstone::geometry {

/// Indices of points, counter-clockwise seen from outside.
using Triangle = std::array<std::uint16_t, 3>;

struct HullTriangles {
  HullFault fault = HullFault::none;  ///< coincident, collinear, flat
  Length tolerance{};                 ///< that was applied
  std::vector<Triangle> triangles;
};

/// `points` are sorted and differ, |coordinate| ≤ k_max_asset_coordinate. The triangles are the
/// boundary of the exact hull of their own vertices: coplanar neighbours are possible, and vertices
/// inside a face or an edge.
///
/// An incremental hull, the farthest point next (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, The
/// Quickhull algorithm for convex hulls). Whether a face is visible is exact, a coplanar one is
/// not; so the visible ones are those of a point moved slightly inwards: a disk, whatever the
/// input.
[[nodiscard]] HullTriangles hull_triangles(std::span<const Vec3<Length>> points,
                                           const HullOptions& options);

}  // namespace lockstone::geometry
