// Bodies as kernels read them.
#pragma once

#include "core/dynamics/inertia.h"
#include "core/math/wide/ball_block.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {

[[nodiscard]] inline lanes::SourceBody source_body(const InverseInertia& m) {
  return {{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}};
}

[[nodiscard]] inline lanes::BodyPlace body_place(const Vec3<Position>& position, const Mat3& r) {
  const auto both = [](Unit low, Unit high) { return lanes::scalar::pack(low.raw, high.raw); };
  return {{position.x.raw, position.y.raw, position.z.raw, both(r.x.x, r.x.y), both(r.x.z, r.y.x),
           both(r.y.y, r.y.z), both(r.z.x, r.z.y), both(r.z.z, {})}};
}

}  // namespace lockstone
