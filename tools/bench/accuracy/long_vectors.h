// Vectors of long double, for references.
#pragma once

#include <array>

namespace lockstone::bench {

using Long = long double;
using Long3 = std::array<Long, 3>;

[[nodiscard]] constexpr Long dot(const Long3& a, const Long3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace lockstone::bench
