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

/// Within eight steps of what rows can read, 7.6 µm/s: what contacts hold trembles by so much, and
/// does not move.
[[nodiscard]] inline bool is_still(const lanes::RowBody& row) {
  constexpr std::int64_t k_least = std::int64_t{8} << (lanes::k_velocity_bits - 20);
  const auto still = [](std::int64_t x) { return x < k_least && x > -k_least; };
  return still(row.velocity[0]) && still(row.velocity[1]) && still(row.velocity[2]) &&
         still(row.spin[0]) && still(row.spin[1]) && still(row.spin[2]);
}

/// Where nothing of a body is faster than eight times that, each of its components by itself: what
/// sinks or rises by a hair on a slope does not creep down meanwhile. Only of bodies that touch but
/// one, which does not give way: in a pile, what is dropped adds up.
[[nodiscard]] inline lanes::RowBody steadied(const lanes::RowBody& row) {
  constexpr std::int64_t k_least = std::int64_t{8} << (lanes::k_velocity_bits - 20);
  constexpr std::int64_t k_slow = 8 * k_least;
  const auto below = [](std::int64_t x, std::int64_t bound) { return x < bound && x > -bound; };
  lanes::RowBody result = row;
  for (std::size_t i = 0; i < 3; ++i)
    if (!below(row.velocity[i], k_slow) || !below(row.spin[i], k_slow)) return row;
  for (std::size_t i = 0; i < 3; ++i) {
    if (below(row.velocity[i], k_least)) result.velocity[i] = 0;
    if (below(row.spin[i], k_least)) result.spin[i] = 0;
  }
  return result;
}

/// Slower than 1/4 m/s along each axis: what contacts carry may be taken for weight.
[[nodiscard]] inline bool is_at_rest(const lanes::RowBody& row) {
  constexpr std::int64_t k_most = std::int64_t{1} << (lanes::k_velocity_bits - 2);
  const auto slow = [](std::int64_t v) { return v < k_most && v > -k_most; };
  return slow(row.velocity[0]) && slow(row.velocity[1]) && slow(row.velocity[2]);
}

}  // namespace lockstone
