// The simplex of GJK on the lattice: which of its vertices carry the point closest to the origin,
// decided by the signs of exact determinants.
//
// Gilbert, Johnson and Keerthi, A fast procedure for computing the distance between complex objects
// in three-dimensional space; the choice by cofactors is that of Montanari, Petrinic and Barbieri,
// Improving the GJK algorithm for faster and more reliable distance queries between convex objects,
// with the optimality of each candidate checked instead of a walk through the cofactors.
#pragma once

#include <array>

#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/numeric/wide_vectors.h"

namespace lockstone::geometry {

/// One to four vertices of B − A. Up to three of them are the least set that holds the closest
/// point v, with positive weights; then `normal` says where v is: at a vertex, v itself; of an edge
/// from v₀ along e, v₀ × e, square to both v and e; of a triangle, (v₁ − v₀) × (v₂ − v₀), which
/// points from the origin to v.
struct Simplex {
  int count = 0;
  std::array<DifferenceVertex, 4> vertices{};
  RawVec normal{};
};

/// A simplex of one vertex.
[[nodiscard]] Simplex simplex_of(const DifferenceVertex& vertex);

/// Whether the simplex with `point` comes closer to the origin: v · point < v · v, exact.
[[nodiscard]] bool improves(const Simplex& simplex, const RawVec& point);

/// Adds a vertex that improves and keeps the least set that holds the closest point; the vertex
/// is part of it. True when the origin lies in that set: at a vertex, on an edge or triangle, or
/// within or on a tetrahedron.
[[nodiscard]] bool extend(Simplex& simplex, const DifferenceVertex& vertex);

/// The direction of v, exact before its components are cut to 31 bits.
[[nodiscard]] RawVec direction_to(const Simplex& simplex);

/// Weights of a triangle's vertices at v, exact: numerators over a common denominator.
struct TriangleWeights {
  std::array<Int128, 3> numerators;
  Int128 denominator;
};
[[nodiscard]] TriangleWeights weights_of(const RawVec& a, const RawVec& b, const RawVec& c);

}  // namespace lockstone::geometry
