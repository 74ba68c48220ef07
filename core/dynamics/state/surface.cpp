#include "core/dynamics/state/surface.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/math/roots.h"

namespace lockstone {
namespace {

Coefficient combine(CombineRule rule, Coefficient a, Coefficient b) {
  LKS_ASSERT(a.raw >= 0 && b.raw >= 0);
  switch (rule) {
    case CombineRule::average:
      return Coefficient::from_raw(
          static_cast<std::int32_t>(raw::round_shift(std::int64_t{a.raw} + b.raw, 1)));
    case CombineRule::minimum:
      return min(a, b);
    case CombineRule::multiply:
      return rounded<Coefficient>(a * b);
    case CombineRule::maximum:
      return max(a, b);
    case CombineRule::standard:
    case CombineRule::geometric_mean:
      break;
  }
  if (a == b) return a;
  return Coefficient::from_raw(
      static_cast<std::int32_t>(isqrt(static_cast<std::uint64_t>((a * b).raw))));
}

CombineRule rule_of(CombineRule a, CombineRule b, CombineRule standard) {
  const CombineRule rule = std::max(a, b);
  return rule == CombineRule::standard ? standard : rule;
}

}  // namespace

// Products of factors of at most 1.99 may leave the range of 2.
Coefficient combined_friction(const Surface& a, const Surface& b) {
  const CombineRule rule = rule_of(a.friction_rule, b.friction_rule, CombineRule::geometric_mean);
  if (rule != CombineRule::multiply) return combine(rule, a.friction, b.friction);
  return saturated<Coefficient>(a.friction * b.friction);
}

Coefficient combined_restitution(const Surface& a, const Surface& b) {
  return combine(rule_of(a.restitution_rule, b.restitution_rule, CombineRule::maximum),
                 a.restitution, b.restitution);
}

Coefficient combined_rolling(const Surface& a, const Surface& b) {
  return combine(rule_of(a.rolling_rule, b.rolling_rule, CombineRule::maximum),
                 a.rolling_resistance, b.rolling_resistance);
}

}  // namespace lockstone
