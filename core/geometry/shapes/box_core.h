// Boxes, and the boxes at the core of rounded ones: `size` holds half extents.
#pragma once

#include "core/geometry/convex/shape_traits.h"

namespace lockstone::geometry {

[[nodiscard]] Fine box_reach(const Shape& shape, const Vec3<Unit>& n);
[[nodiscard]] Vec3<Unit> box_face_along(const Shape& shape, const Vec3<Unit>& axis);
[[nodiscard]] std::optional<std::uint32_t> box_vertex_at(const Shape& shape, const RawVec& point);
[[nodiscard]] int box_vertices(const Shape& shape, std::array<RawVec, 8>& out);
void box_core(const PosedShape& shape, ConvexCore& core);

}  // namespace lockstone::geometry
