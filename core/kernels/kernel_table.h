// One entry for each target that a build has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/kernels/ball/ball_block.h"
#include "core/kernels/box/box_block.h"
#include "core/kernels/contact/contact_rows.h"
#include "core/kernels/contact/manifold_block.h"
#include "core/kernels/points/points.h"
#include "core/kernels/proximal/proximal_block.h"
#include "core/kernels/rotations/rotations.h"

namespace lockstone::lanes {

struct Kernels {
  std::string_view target;
  std::size_t lanes = 0;
  void (*compute_rotations)(const QuatField& quats, const std::uint32_t* indices, std::size_t count,
                            Mat3* matrices);
  Farthest (*farthest_point)(const PointColumns& points, const Direction32& n);
  Extent (*extent_along)(const PointColumns& points, const Direction32& n);
  Farthest (*heights_above)(const PointColumns& normals, const std::int64_t* offsets,
                            const Direction32& p, std::int64_t* heights);
  void (*mark_at_least)(const std::int64_t* heights, std::size_t count, std::int64_t bound,
                        std::uint64_t* marks);
  const ManifoldKernels* manifolds;
  const BallKernels* balls;
  const BoxKernels* boxes;
  const ProximalKernels* proximal;
};

#if defined(LOCKSTONE_WITH_HIGHWAY)
/// The kernels of a target, or null when this build has not compiled them.
[[nodiscard]] const Kernels* highway_kernels(std::string_view target);
#endif

}  // namespace lockstone::lanes
