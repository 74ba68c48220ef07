// Three raw numbers by axis, in whatever format their user says.
#pragma once

#include <array>
#include <cstdint>

namespace lockstone {

using RawVec3 = std::array<std::int64_t, 3>;

[[nodiscard]] constexpr RawVec3 negated(const RawVec3& v) {
  return {-v[0], -v[1], -v[2]};
}

/// a × b, exact: the products, and their differences, fit.
[[nodiscard]] constexpr RawVec3 cross(const RawVec3& a, const RawVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace lockstone
