// Faces of a hull: its triangles, merged where they lie in one plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/convex/hull_triangles.h"
#include "core/geometry/convex/polytope.h"

namespace lockstone::geometry {

/// Vertices around a face, counter-clockwise seen from outside, the least index first.
using Loop = std::vector<std::uint16_t>;

struct MergedFaces {
  std::vector<Loop> loops;            ///< ascending
  std::vector<std::uint16_t> dented;  ///< vertices, ascending, that made a union not convex
};

/// `triangles` bound the exact hull of `vertices`, at most k_max_polytope_vertices. Triangles of
/// one plane become one face. Then faces that share an edge are merged, the flattest pair first, as
/// long as the result is strictly convex seen along its normal and has its vertices at most
/// `tolerance` below its plane (see `supporting_face`).
[[nodiscard]] MergedFaces merge_faces(std::span<const Vec3<Length>> vertices,
                                      std::span<const Triangle> triangles, Length tolerance);

/// The plane with the mean normal of the loop (by Newell's sum) that touches the vertices from
/// outside, and how far below it vertices of the loop reach.
struct SupportingFace {
  Vec3<Unit> normal{};
  Fine offset = 0;
  Fine depth = 0;
};
[[nodiscard]] SupportingFace supporting_face(std::span<const Vec3<Length>> vertices,
                                             const Loop& loop);

}  // namespace lockstone::geometry
