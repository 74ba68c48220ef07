#include "core/geometry/numeric/normals.h"

#include "core/math/roots.h"

namespace lockstone::geometry {

Vec3<Unit> perpendicular_to(const Vec3<Unit>& axis) {
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (abs(axis[k]) < abs(axis[least])) least = k;
  }
  const int u = (least + 1) % 3;
  const int v = (least + 2) % 3;
  RawVec result;  // axis × e_least
  result[u] = axis[v].raw;
  result[v] = -std::int64_t{axis[u].raw};
  return direction_of(result.x, result.y, result.z);
}

Vec3<Unit> unit_axis(const Vec3<Unit>& axis) {
  constexpr std::int64_t one = std::int64_t{1} << 60;
  constexpr std::int64_t tolerance = std::int64_t{1} << 31;  // 2·δ for |axis| = 1 + δ, δ = 2^-30
  const std::int64_t square = lockstone::dot(axis, axis).raw;
  if (magnitude_of(square - one) <= tolerance) return axis;
  return direction_of(axis);
}

}  // namespace lockstone::geometry
