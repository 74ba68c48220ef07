#include "core/geometry/distance/half_space_gap.h"

#include "core/geometry/numeric/normals.h"

namespace lockstone::geometry {

HalfSpaceGap half_space_gap(const PosedShape& half_space, const PosedShape& shape,
                            const RawVec& offset) {
  ConvexCore core;
  make_core(shape, core);
  HalfSpaceGap gap;
  gap.normal = unit_axis(half_space.rotation.y);
  RawVec deepest;
  for (int i = 0; i < vertex_count(core); ++i) {
    const RawVec vertex = vertex_of(core, i);
    const Fine height = dot(vertex + offset, gap.normal);
    if (i != 0 && height >= gap.distance) continue;
    gap.distance = height;
    gap.vertex = static_cast<std::uint8_t>(i);
    deepest = vertex;
  }
  gap.distance -= fine(core.radius);
  gap.on_shape = deepest - along(gap.normal, core.radius);
  gap.on_plane = gap.on_shape + offset - along(gap.normal, gap.distance);
  return gap;
}

}  // namespace lockstone::geometry
