// How a pair of bodies shares a velocity jump.
#pragma once

#include <cstdint>

#include "core/math/block_float.h"

namespace lockstone {

/// α of B, mB⁻¹ / (mA⁻¹ + mB⁻¹), Q30; the share of an immovable body is 0.
[[nodiscard]] inline std::int32_t share_of_b(const BlockFloat& a, const BlockFloat& b) {
  if (a == b) return 1 << 29;
  return ratio(b, a).raw;
}

}  // namespace lockstone
