#include "core/dynamics/step/input/contact_params.h"

#include <lockstone/assert.h>

namespace lockstone {
namespace {

// Overlap is pushed out at most this fast, m/s, Q20.
constexpr std::int32_t k_push_out_speed = 3 << 20;

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 1 & 0x55555555U) | (x & 0x55555555U) << 1;
  x = (x >> 2 & 0x33333333U) | (x & 0x33333333U) << 2;
  x = (x >> 4 & 0x0f0f0f0fU) | (x & 0x0f0f0f0fU) << 4;
  x = (x >> 8 & 0x00ff00ffU) | (x & 0x00ff00ffU) << 8;
  return x >> 16 | x << 16;
}
static_assert(reversed(0x80000000U) == 1 && reversed(0x12345678U) == 0x1e6a2c48U);

}  // namespace

bool is_touching(const Manifold& manifold) {
  for (int i = 0; i < manifold.count; ++i)
    if (manifold.points[static_cast<std::size_t>(i)].separation <= k_contact_slop) return true;
  return false;
}

// step = 1/rate = mantissa · 2^-(7 + shift)
lanes::SolverParams solver_params(const TimeStep& step) {
  const std::int64_t rate = step.substep_rate();
  LKS_ASSERT(rate >= 1);
  int shift = 32;
  while (raw::round_divide(std::int64_t{1} << (7 + shift), rate) > INT32_MAX)
    --shift;
  LKS_ASSERT(shift >= 1);
  const std::int64_t mantissa = raw::round_divide(std::int64_t{1} << (7 + shift), rate);
  return {static_cast<std::int32_t>(rate),
          k_push_out_speed,
          k_contact_slop.raw,
          k_resting_overlap.raw,
          static_cast<std::int32_t>(mantissa),
          shift};
}

lanes::SolverParams dithered(lanes::SolverParams params, std::uint32_t substep) {
  constexpr std::uint32_t k_golden = 0x9e3779b9;
  constexpr std::int32_t k_half = 1 << 29;
  params.limit_dither = static_cast<std::int32_t>(reversed(substep) >> 2) - k_half;
  params.part_dither = static_cast<std::int32_t>((substep * k_golden) >> 2) - k_half;
  LKS_ASSERT(params.limit_dither >= -k_half && params.limit_dither < k_half);
  LKS_ASSERT(params.part_dither >= -k_half && params.part_dither < k_half);
  return params;
}

}  // namespace lockstone
