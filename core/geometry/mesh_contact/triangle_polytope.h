// Triangles of meshes and height fields as convex polyhedra of two faces, and how their edges may
// be met.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/polytope.h"

namespace lockstone::geometry {

/// Counter-clockwise seen from the front.
using TriangleVertices = std::array<Vec3<Length>, 3>;

/// The front normal, norm 1 within 2^-29; zero for a triangle without area. Coordinates within
/// ±512 m: then the cross product is exact in 64 bits.
[[nodiscard]] Vec3<Unit> triangle_normal(const TriangleVertices& triangle);

/// Whether the vertices lie on one line, exactly. Coordinates within ±512 m.
[[nodiscard]] bool is_degenerate(const TriangleVertices& triangle);

[[nodiscard]] LocalBounds bounds_of(const TriangleVertices& triangle);

/// Whether an edge may be met as an edge. `triangle` has the edge from its vertex `edge` to the
/// next; `apex` is the vertex of the one neighbour that does not lie on it. Concave and flat edges
/// are inactive, and convex ones whose normals differ by an angle of cosine ≥ `flat_cosine`; with
/// flat_cosine = 1 every convex edge is active. A neighbour folded back on the triangle makes it
/// active. The side is decided exactly (as ActiveEdges of Jolt Physics, there with rounding).
[[nodiscard]] bool is_edge_active(const TriangleVertices& triangle, int edge,
                                  const Vec3<Length>& apex, Unit flat_cosine);

/// The vertices at an end of an active edge of this triangle.
[[nodiscard]] constexpr TriangleTopology triangle_topology(std::uint8_t active_edges) {
  const unsigned edges = active_edges;
  const unsigned starts = edges | ((edges << 1) & 7U) | (edges >> 2);
  return {true, active_edges, static_cast<std::uint8_t>(starts)};
}

/// Scratch that backs a `Polytope`: face 0 is the front, face 1 the back.
class TrianglePolytope {
 public:
  TrianglePolytope();
  TrianglePolytope(const TrianglePolytope&) = delete;
  TrianglePolytope& operator=(const TrianglePolytope&) = delete;

  /// The triangle has area. The view stays valid until the next call.
  const Polytope& set(const TriangleVertices& triangle);

 private:
  TriangleVertices vertices_{};
  std::array<PolytopeFace, 2> faces_{};
  Polytope view_;
};

/// One visitor's scratch: presents triangles as parts.
class TrianglePart {
 public:
  TrianglePart();

  const Part& set(std::uint32_t index, const TriangleVertices& triangle, std::uint8_t active_edges,
                  const Surface* surface);

 private:
  TrianglePolytope polytope_;
  Part part_;
};

}  // namespace lockstone::geometry
