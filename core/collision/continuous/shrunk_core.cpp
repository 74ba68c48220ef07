#include "core/collision/continuous/shrunk_core.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

// The least distance of the interior point from a face.
Length inner_radius_of(const geometry::Polytope& polytope) {
  std::int64_t least = geometry::fine(k_max_shape_size);
  for (const geometry::PolytopeFace& face : polytope.faces)
    least = std::min(least, face.offset - dot(face.normal, polytope.interior).raw);
  return polytope.radius + Length::from_raw(static_cast<std::int32_t>(
                               std::max<std::int64_t>(least, 0) >> geometry::k_fine_per_length));
}

}  // namespace

Length inner_radius_of(const Piece& piece) {
  return piece.polytope != nullptr ? inner_radius_of(*piece.polytope) : inner_radius(piece.shape);
}

ShrunkCore::ShrunkCore(const Piece& piece, Length depth, Unit share) : shape(piece.shape) {
  LKS_ASSERT(depth >= Length{} && share > Unit{} && share <= Unit::from_integer(1));
  if (piece.polytope != nullptr) {
    // The radius shrinks first.
    const Length from_radius = min(depth, piece.polytope->radius);
    move_vertices_inward(*piece.polytope, depth - from_radius);
    polytope.radius = piece.polytope->radius - from_radius;
    LKS_ASSERT(polytope.radius >= Length{});
  } else {
    shape = geometry::traits_of(shape).shrunk(shape, depth);
  }
  if (share != Unit::from_integer(1)) shorten(share);
}

void ShrunkCore::shorten(Unit share) {
  LKS_ASSERT(share > Unit{} && share <= Unit::from_integer(1));
  if (!is_polytope) {
    shape = geometry::traits_of(shape).shortened(shape, share);
    return;
  }
  for (std::size_t i = 0; i < polytope.vertices.size(); ++i) {
    Vec3<Length>& vertex = vertices_[i];
    vertex = polytope.interior + rounded<Length>((vertex - polytope.interior) * share);
  }
}

void ShrunkCore::move_vertices_inward(const geometry::Polytope& full, Length depth) {
  LKS_ASSERT(full.vertices.size() <= vertices_.size());
  std::array<geometry::RawVec, geometry::k_max_polytope_vertices> normals{};
  for (const geometry::HalfEdge& edge : full.edges) {
    geometry::RawVec& sum = normals[edge.origin];
    sum = sum + geometry::raws_of(full.faces[edge.face].normal);
  }
  for (std::size_t i = 0; i < full.vertices.size(); ++i) {
    const geometry::RawVec& n = normals[i];
    const Vec3<Unit> outward = direction_of(n.x, n.y, n.z);
    for (int axis = 0; axis < 3; ++axis)
      vertices_[i][axis] = full.vertices[i][axis] - rounded<Length>(outward[axis] * depth);
  }
  polytope = full;
  polytope.vertices = std::span(vertices_).first(full.vertices.size());
  is_polytope = true;
}

}  // namespace lockstone
