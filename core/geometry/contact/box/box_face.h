// Face contacts of two boxes: the incident face clipped against the sides of the reference face.
#pragma once

#include "core/geometry/contact/box/box_pair.h"

namespace lockstone::geometry {

/// The contact on a face of one of the two boxes: of B when `of_b`, else of A. The face's normal
/// points from A to B. With `flip` the manifold is that of B and A.
///
/// The face of the other box that is most opposed is clipped to the sides of this one, both sides
/// across an axis at once, each edge between its own ends: so neither the order of the sides nor
/// the direction of an edge matters. A vertex beyond a side by less than k_snap counts as on it and
/// keeps its feature, so that boxes stacked flush do not change features as they tremble; not on a
/// steep face, where the height would change too much. Of more than four points `reduce_to_four`
/// keeps four, those that are held if it can.
/// Returns whether the boxes are known to overlap by `wanted` along every axis, because they share
/// a ball of that diameter; at 0 a point will do. False where the polygon alone does not show it,
/// and for `wanted` < 0.
bool face_manifold(const BoxPair& pair, const FaceAxis& face, bool of_b, bool flip, Fine wanted,
                   const HeldFeatures& held, Manifold& out);

}  // namespace lockstone::geometry
