#include "core/geometry/distance/cores/half_space_gap.h"

#include "core/geometry/numeric/normals.h"

namespace lockstone::geometry {

HalfSpaceGap half_space_gap(const PosedShape& half_space, const PosedShape& shape,
                            const RawVec& offset) {
  ConvexCore core;
  make_core(shape, core);
  HalfSpaceGap gap;
  gap.normal = unit_axis(half_space.rotation.y);
  RawVec deepest;
  const int count = core.rims.count != 0 ? 0 : vertex_count(core);  // rims: see below
  for (int i = 0; i < count; ++i) {
    const RawVec vertex = vertex_of(core, i);
    const Fine height = dot(vertex + offset, gap.normal) - swell_at(core, i);
    if (i != 0 && height >= gap.distance) continue;
    gap.distance = height;
    gap.vertex = static_cast<int>(i);
    deepest = is_tapered(core) ? vertex - along(gap.normal, swell_at(core, i)) : vertex;
  }
  if (core.rims.count != 0) {
    const Vec3<Unit>& n = gap.normal;
    gap.vertex = farthest_rim_vertex(core.rims, {-n.x.raw, -n.y.raw, -n.z.raw});
    deepest = vertex_of(core, gap.vertex);
    gap.distance = dot(deepest + offset, n);
  }
  gap.distance -= fine(core.radius);
  gap.on_shape = deepest - along(gap.normal, core.radius);
  gap.on_plane = gap.on_shape + offset - along(gap.normal, gap.distance);
  return gap;
}

}  // namespace lockstone::geometry
