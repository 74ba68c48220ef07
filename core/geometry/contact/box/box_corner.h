// Single contacts of two boxes: edge against edge, and a vertex against the nearest feature.
#pragma once

#include "core/geometry/contact/box/box_pair.h"

namespace lockstone::geometry {

struct EdgeContact {
  Manifold manifold;
  bool crossing =
      false;  ///< the closest points lie inside both edges, so the separation is the distance
};

/// One point between the edges that support the axis.
[[nodiscard]] EdgeContact edge_contact(const BoxPair& pair, const EdgeAxis& axis);

/// The axis of two edges whose contact has this feature.
[[nodiscard]] EdgeAxis edge_axis_of(const BoxPair& pair, std::uint32_t feature);

/// Boxes apart whose nearest features include a vertex: the nearest of the sixteen vertices to the
/// other box. Precondition: they do not overlap.
[[nodiscard]] Manifold vertex_manifold(const BoxPair& pair);

}  // namespace lockstone::geometry
