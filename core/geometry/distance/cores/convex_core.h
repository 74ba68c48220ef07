// Cores of convex shapes, exact and on a lattice: a point, a segment, a box or a polytope's
// vertices, which a radius makes round.
//
// On the lattice every point of the difference B − A has a norm of at most 2^30 (and a little for
// rounding), so that dot and cross products of differences fit in int64, and the determinants that
// GJK and EPA decide by fit in 128 bits: nothing there is an estimate.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/convex/polytope.h"
#include "core/geometry/distance/cores/rims.h"
#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// The vertices of a core in world axes, about `reference`, exact in fine lanes. Without listed
/// vertices they are the sums ±g₀ ±g₁ ±g₂ of the generators: none for a sphere, one for a capsule,
/// three for a box. Bit i of such a vertex' index is set where gᵢ is added. Rims stand for all
/// vertices, and for themselves on the lattice; their reference is the shape's centre.
struct ConvexCore {
  int generator_count = 0;
  int vertex_count = 0;  ///< listed; of polytopes only
  Length radius{};
  Rims rims{};
  RawVec reference{};  ///< from the shape's centre
  RawVec extent{};     ///< greatest |coordinate| about the reference, by axis
  std::array<RawVec, 3> generators{};
  /// By how much the balls about the two vertices of a tapered core exceed `radius`, one of them by
  /// nothing: the core is the hull of a ball and a point. Zero of all others.
  std::array<Fine, 2> swell{};
  const Polytope* polytope = nullptr;  ///< whose vertices are listed, turned by `rotation`
  Mat3 rotation{};
  // Left unset beyond vertex_count.
  std::array<Fine, k_max_polytope_vertices> x;
  std::array<Fine, k_max_polytope_vertices> y;
  std::array<Fine, k_max_polytope_vertices> z;
};

/// The core of a primitive or polytope, written into `core`.
void make_core(const PosedShape& shape, ConvexCore& core);

/// Adds ±generator to every vertex; none are listed.
void add_generator(ConvexCore& core, const RawVec& generator);

/// Whether the core is that of a tapered capsule: its vertices are balls, which GJK does not know.
[[nodiscard]] constexpr bool is_tapered(const ConvexCore& core) {
  return core.swell[0] != core.swell[1];
}

/// Of a vertex.
[[nodiscard]] constexpr Fine swell_at(const ConvexCore& core, int vertex) {
  return is_tapered(core) ? core.swell[static_cast<std::size_t>(vertex)] : 0;
}

/// How many indices of vertices there are in a core without rims.
[[nodiscard]] constexpr int vertex_count(const ConvexCore& core) {
  return core.vertex_count != 0 ? core.vertex_count : 1 << core.generator_count;
}

/// Whether the core is its reference alone: that of a sphere.
[[nodiscard]] constexpr bool is_point(const ConvexCore& core) {
  return core.rims.count == 0 && core.vertex_count == 0 && core.generator_count == 0;
}

/// Where a vertex is, from the shape's centre.
[[nodiscard]] RawVec vertex_of(const ConvexCore& core, int index);

/// The vertex that reaches farthest along a direction, whose components are below 2^62.
[[nodiscard]] int farthest_vertex(const ConvexCore& core, const RawVec& direction);

/// The point of the core, swell included, that is farthest along a unit vector.
[[nodiscard]] RawVec farthest_point(const ConvexCore& core, const Vec3<Unit>& n);

/// A core in lattice steps, about its reference.
struct LatticeCore {
  int generator_count = 0;
  int vertex_count = 0;
  const Rims* rims = nullptr;  ///< the core's own, if it has any
  int shift = 0;
  std::array<RawVec, 3> generators{};
  std::array<std::int32_t, k_max_polytope_vertices> x;
  std::array<std::int32_t, k_max_polytope_vertices> y;
  std::array<std::int32_t, k_max_polytope_vertices> z;
};

/// Two cores on one lattice. One step is 2^shift fine units, at most 2^-29 of the greatest distance
/// of a point of B from a point of A; a vertex is off by at most 3.5 steps.
struct LatticePair {
  LatticeCore a;
  LatticeCore b;
  RawVec offset{};  ///< of b's reference from a's
  int shift = 0;
};

/// A vertex of the difference B − A.
struct DifferenceVertex {
  RawVec point{};  ///< lattice
  int a = 0;
  int b = 0;
};

/// The fine offset from a's reference to b's, `offset` being that of the shapes' centres.
[[nodiscard]] RawVec reference_offset(const ConvexCore& a, const ConvexCore& b,
                                      const RawVec& offset);

/// The step that fits the pair: see `LatticePair`. Every |component| of B − A is below 2^12 m.
[[nodiscard]] int lattice_shift(const ConvexCore& a, const ConvexCore& b, const RawVec& offset);

/// Brings the cores, which must stay where they are, to the lattice of 2^shift; the offset is that
/// of the references.
void to_lattice(const ConvexCore& a, const ConvexCore& b, int shift, LatticePair& pair);
void set_offset(const RawVec& offset, LatticePair& pair);

/// The vertex of B − A least along `direction`, whose components are below 2^31; the first of
/// equals.
[[nodiscard]] DifferenceVertex least_along(const LatticePair& pair, const RawVec& direction);

/// The vertex of B − A greatest along `direction`, for every direction, exact.
[[nodiscard]] DifferenceVertex greatest_along(const LatticePair& pair, const RawVec& direction);

}  // namespace lockstone::geometry
