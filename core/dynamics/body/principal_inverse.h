// The inverse of principal moments, as far as it does not depend on where a body is.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/body/inertia.h"

namespace lockstone {

/// 1/I about each principal axis: raw · 2^(exponent − 30), raw at most 2^30.
struct PrincipalInverse {
  std::array<std::int32_t, 3> raw{};
  int exponent = 0;
};

/// Of moments of at least `k_min_inertia`.
[[nodiscard]] PrincipalInverse principal_inverse(const Vec3<Unit>& moments);

/// R·diag(1/I)·Rᵀ
[[nodiscard]] InverseInertia inverse_inertia(const PrincipalInverse& inverse, const Mat3& rotation);

}  // namespace lockstone
