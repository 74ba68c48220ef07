// The surface of a polytope with a radius as facets: for volumes under water and for pictures.
#pragma once

#include <array>
#include <span>

#include "core/geometry/convex/polytope.h"
#include "core/math/roots.h"

namespace lockstone::geometry {

/// How far the facets reach in the middle of an edge or a vertex: as far as the surface, or
/// farther, so that they enclose the volume of the rounded parts within 2 %.
enum class FacetReach : std::uint8_t { surface, volume };

class RoundedFacets {
 public:
  RoundedFacets(const Polytope& polytope, FacetReach reach) : polytope_(polytope), reach_(reach) {}

  /// Calls `f` with the corners of each facet, fine, counter-clockwise seen from outside: the faces
  /// raised by the radius, two strips along each edge, a fan of two triangles an edge around each
  /// vertex.
  template <class F>
  void for_each(F&& f) const {
    std::array<RawVec, k_max_polytope_face_edges> corners;
    for (const PolytopeFace& face : polytope_.faces) {
      for (std::size_t i = 0; i < face.edge_count; ++i)
        corners[i] = vertex_at(static_cast<int>(face.first_edge + i)) + raised(face.normal);
      f(std::span<const RawVec>(corners).first(face.edge_count));
    }
    for (int edge = 0; edge < static_cast<int>(polytope_.edges.size()); ++edge)
      for_each_of(edge, f);
  }

 private:
  /// The half of the edge's strip beside its face, and two triangles at its origin.
  template <class F>
  void for_each_of(int edge, F&& f) const {
    const int twin = polytope_.edges[static_cast<std::size_t>(edge)].twin;
    const Vec3<Unit>&here = normal_at(edge), &there = normal_at(twin);
    const RawVec from = vertex_at(edge), to = vertex_at(twin);
    const RawVec face = raised(here), middle = between(raws_of(here) + raws_of(there), here);
    const std::array<RawVec, 4> strip{to + face, from + face, from + middle, to + middle};
    f(std::span<const RawVec>(strip));
    const RawVec tip = from + tip_of(edge);
    const std::array<RawVec, 3> first{from + middle, from + face, tip};
    f(std::span<const RawVec>(first));
    const std::array<RawVec, 3> second{from + raised(there), from + middle, tip};
    f(std::span<const RawVec>(second));
  }

  [[nodiscard]] const Vec3<Unit>& normal_at(int edge) const {
    return polytope_.faces[polytope_.edges[static_cast<std::size_t>(edge)].face].normal;
  }
  [[nodiscard]] RawVec vertex_at(int edge) const { return fine(start_of(polytope_, edge)); }
  [[nodiscard]] RawVec raised(const Vec3<Unit>& n) const { return along(n, polytope_.radius); }

  /// The direction along `sum`, which leans from `face` by φ; of the volume, longer by about
  /// φ / sin φ.
  [[nodiscard]] RawVec between(const RawVec& sum, const Vec3<Unit>& face) const {
    const Vec3<Unit> n = direction_of(sum.x, sum.y, sum.z);
    if (reach_ == FacetReach::surface) return raised(n);
    const std::int64_t fall = (std::int64_t{1} << 60) - lockstone::dot(n, face).raw;
    const Fine longer =
        scaled(fine(polytope_.radius), static_cast<std::int32_t>(raw::round_shift(fall, 30) / 3));
    return raised(n) + along(n, longer);
  }

  /// Between all faces around the half edge's origin.
  [[nodiscard]] RawVec tip_of(int edge) const {
    RawVec sum;
    int at = edge;
    do {
      sum = sum + raws_of(normal_at(at));
      at = next_edge(polytope_, polytope_.edges[static_cast<std::size_t>(at)].twin);
    } while (at != edge);
    return between(sum, normal_at(edge));
  }

  const Polytope& polytope_;
  FacetReach reach_;
};

}  // namespace lockstone::geometry
