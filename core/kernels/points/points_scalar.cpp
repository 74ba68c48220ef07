#include <algorithm>

#include "core/kernels/points/points.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone::lanes {
namespace {

std::int64_t product(const PointColumns& points, std::size_t i, const Direction32& n) {
  const scalar::Lane x = scalar::multiply(points.x[i], n[0]);
  const scalar::Lane xy = scalar::multiply_add(x, points.y[i], n[1]);
  return scalar::multiply_add(xy, points.z[i], n[2]);
}

}  // namespace

Farthest farthest_point_scalar(const PointColumns& points, const Direction32& n) {
  Farthest best{0, product(points, 0, n)};
  for (std::size_t i = 1; i < points.count; ++i) {
    const std::int64_t reach = product(points, i, n);
    if (reach > best.product) best = {i, reach};
  }
  return best;
}

Extent extent_along_scalar(const PointColumns& points, const Direction32& n) {
  Extent extent{product(points, 0, n), product(points, 0, n)};
  for (std::size_t i = 1; i < points.count; ++i) {
    const std::int64_t reach = product(points, i, n);
    extent = {std::min(extent.least, reach), std::max(extent.greatest, reach)};
  }
  return extent;
}

Farthest heights_above_scalar(const PointColumns& normals, const std::int64_t* offsets,
                              const Direction32& p, std::int64_t* heights) {
  for (std::size_t i = 0; i < normals.count; ++i)
    heights[i] = scalar::subtract(product(normals, i, p), offsets[i]);
  Farthest highest{0, heights[0]};
  for (std::size_t i = 1; i < normals.count; ++i) {
    if (heights[i] > highest.product) highest = {i, heights[i]};
  }
  return highest;
}

void mark_at_least_scalar(const std::int64_t* heights, std::size_t count, std::int64_t bound,
                          std::uint64_t* marks) {
  for (std::size_t first = 0; first < count; first += 64) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < 64 && first + i < count; ++i)
      word |= std::uint64_t{heights[first + i] >= bound} << i;
    marks[first / 64] = word;
  }
}

}  // namespace lockstone::lanes
