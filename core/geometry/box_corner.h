// Single contacts of two boxes: edge against edge, and a vertex against whatever is nearest.
#pragma once

#include "core/geometry/box_pair.h"

namespace lockstone::geometry {

struct EdgeContact {
  Manifold manifold;
  bool crossing =
      false;  ///< the closest points lie inside both edges, so the separation is the distance
};

/// One point between the edges that support the axis.
[[nodiscard]] EdgeContact edge_contact(const BoxPair& pair, const EdgeAxis& axis);

/// Boxes apart whose nearest features include a vertex: the nearest of the sixteen vertices to the
/// other box. Precondition: they do not overlap.
[[nodiscard]] Manifold vertex_manifold(const BoxPair& pair);

/// The vertex of B deepest below A's face, for boxes that overlap outside the face's sides.
[[nodiscard]] Manifold support_manifold(const BoxPair& pair, const FaceAxis& face_of_a);

}  // namespace lockstone::geometry
