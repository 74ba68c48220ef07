// How the surfaces of two bodies meet.
#pragma once

#include <lockstone/asset.h>

#include "core/math/roots.h"

namespace lockstone {

struct SurfacePair {
  Surface a;
  Surface b;
};

/// √(a·b)
[[nodiscard]] inline Coefficient mixed_friction(const SurfacePair& pair) {
  if (pair.a.friction == pair.b.friction) return pair.a.friction;
  const auto product = static_cast<std::uint64_t>((pair.a.friction * pair.b.friction).raw);
  return {static_cast<std::int32_t>(isqrt(product))};
}

[[nodiscard]] constexpr Coefficient mixed_restitution(const SurfacePair& pair) {
  return max(pair.a.restitution, pair.b.restitution);
}

}  // namespace lockstone
