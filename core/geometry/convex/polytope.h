// Convex polyhedra as the kernels see them: hulls, and triangles as polyhedra of two faces.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/numeric/q50.h"
#include "core/kernels/points/points.h"

namespace lockstone::geometry {

struct PolytopeKernels;

/// A plane and the loop of half edges around it. Every vertex v of the polytope has
/// n · v ≤ offset, exactly, and one has equality.
struct PolytopeFace {
  Vec3<Unit> normal{};  ///< outward, norm 1 within 2^-29
  Fine offset = 0;      ///< the greatest n · v, exact
  std::uint16_t first_edge = 0;
  std::uint16_t edge_count = 0;
};

/// Half edges of a face follow one another, counter-clockwise seen from outside.
struct HalfEdge {
  std::uint16_t origin = 0;  ///< vertex
  std::uint16_t twin = 0;    ///< the half edge that runs the other way
  std::uint16_t face = 0;

  friend constexpr bool operator==(const HalfEdge&, const HalfEdge&) = default;
};

/// The same numbers by coordinate. The places after the last vertex and face are filled up.
struct PolytopeLanes {
  lanes::PointColumns vertices;
  lanes::PointColumns normals;
  const Fine* offsets = nullptr;
  const std::uint16_t* leaving = nullptr;  ///< a half edge from each vertex
};

/// Takes the volume of a rounded polytope's facets to its own, and their centre to its centre
/// of mass: see `part_below`.
struct FacetCorrection {
  std::int64_t volume = std::int64_t{1} << 30;  ///< the solid's over the facets', 30 bits
  std::array<std::int64_t, 3>
      centre{};  ///< of the facets, from the centre of mass, of the scale, 48 bits
};

/// A view; the data it points to must outlive it. All in the shape's own frame.
struct Polytope {
  std::span<const Vec3<Length>> vertices;
  std::span<const PolytopeFace> faces;
  std::span<const HalfEdge> edges;
  Vec3<Length> interior{};  ///< a point inside, or on a flat one
  const PolytopeKernels* kernels = nullptr;
  /// Of a flat one that is the surface of a solid: only face 0 pushes, and a shape whose centre is
  /// behind that face does not collide at all.
  bool one_sided = false;
  Fine unevenness = 0;  ///< how far a vertex may lie below a face that it is around
  Length radius{};      ///< by which the shape surrounds the polytope
  const FacetCorrection* facets = nullptr;  ///< of rounded hulls
  const PolytopeLanes* wide = nullptr;      ///< null: few enough to be read one by one
  /// At most the length of any mean of the normals of two faces that share an edge: 1 if they turn
  /// little, 0 if nothing is known.
  Unit least_mean_normal{};
};

/// The same of faces and edges.
[[nodiscard]] Unit least_mean_normal_of(std::span<const PolytopeFace> faces,
                                        std::span<const HalfEdge> edges);

/// Whether faces were merged so roughly that their planes, and the arcs between them, differ from
/// the vertices by more than 15 µm.
[[nodiscard]] constexpr bool is_uneven(const Polytope& p) {
  return p.unevenness > Fine{1} << (k_fine_bits - 16);
}

/// Two faces, back to back, that have all vertices in common: a triangle, say.
[[nodiscard]] constexpr bool is_flat(const Polytope& p) {
  return p.faces.size() == 2;
}

inline constexpr int k_max_polytope_vertices = 128;
inline constexpr int k_max_polytope_faces = 252;
inline constexpr int k_max_polytope_edges = 756;       ///< half edges
inline constexpr int k_max_polytope_face_edges = 128;  ///< half edges around one face

/// Half edge after `edge` around its face.
[[nodiscard]] constexpr std::uint16_t next_edge(const Polytope& p, std::uint16_t edge) {
  const PolytopeFace& face = p.faces[p.edges[edge].face];
  const int after = edge + 1;
  const bool wraps = after == face.first_edge + face.edge_count;
  return static_cast<std::uint16_t>(wraps ? face.first_edge : after);
}

[[nodiscard]] constexpr const Vec3<Length>& start_of(const Polytope& p, int edge) {
  return p.vertices[p.edges[static_cast<std::size_t>(edge)].origin];
}
[[nodiscard]] constexpr const Vec3<Length>& end_of(const Polytope& p, int edge) {
  return start_of(p, p.edges[static_cast<std::size_t>(edge)].twin);
}

/// Exact: coordinates within ±1000 m differ by less than 2048 m.
[[nodiscard]] constexpr Vec3<Length> edge_vector(const Polytope& p, int edge) {
  return end_of(p, edge) - start_of(p, edge);
}

/// Of the two half edges of an edge, the one that stands for both.
[[nodiscard]] constexpr bool is_first_half(const Polytope& p, int edge) {
  return edge < p.edges[static_cast<std::size_t>(edge)].twin;
}

struct Support {
  int vertex = 0;
  Fine height = 0;
};

/// The vertex with the greatest n · v, the first of equals; exact.
[[nodiscard]] Support support_of(const Polytope& polytope, const Vec3<Unit>& n);

/// How far it reaches along n: the least and the greatest n · v, exact.
[[nodiscard]] lanes::Extent extent_along(const Polytope& polytope, const Vec3<Unit>& n);

using FaceHeights = std::array<Fine, 256>;  // room to fill up the last lanes
static_assert(k_max_polytope_faces <= 256);

/// How high a point (own frame, 20 fraction bits) is above each face's plane; exact. Returns the
/// face that it is highest above, the first of equals. The places after the last face mean nothing.
int measure_heights(const Polytope& polytope, const RawVec& point, FaceHeights& heights);

/// A bit for each face.
using FaceBits = std::array<std::uint64_t, 4>;

/// The faces whose height is at least `bound`.
void mark_faces(const Polytope& polytope, const FaceHeights& heights, Fine bound, FaceBits& marks);

/// Calls `f(face)` for every face that is marked, in order.
template <class F>
void for_each_marked(const FaceBits& marks, F&& f) {
  for (std::size_t word = 0; word < marks.size(); ++word) {
    for (std::uint64_t bits = marks[word]; bits != 0; bits &= bits - 1)
      f(static_cast<int>(word * 64) + std::countr_zero(bits));
  }
}

/// Of the faces around `vertex`, the one with the least n · direction, the first of
/// equals.
[[nodiscard]] int most_opposed_face(const Polytope& polytope, int vertex,
                                    const Vec3<Unit>& direction);

}  // namespace lockstone::geometry
