// Where a side plane cuts an edge of a polygon.
#pragma once

#include "core/geometry/numeric/q50.h"
#include "core/math/int128.h"

namespace lockstone::geometry {

/// depth / (depth + excess), 64 fraction bits, below 1: so fine that an edge cut by two opposite
/// sides is cut alike in either order. Measured from the inside, so that the direction of the edge
/// does not matter. depth > 0, excess > 0, any unit; the sum fits 64 bits.
[[nodiscard]] constexpr std::uint64_t share_inside(std::int64_t depth, std::int64_t excess) {
  const auto inside = static_cast<std::uint64_t>(depth);
  return divide(UInt128{inside, 0}, inside + static_cast<std::uint64_t>(excess)).quotient;
}

/// inside + share · (outside − inside), to nearest, ties away from `inside`.
[[nodiscard]] constexpr Fine cut_between(Fine inside, Fine outside, std::uint64_t share) {
  const Fine rise = raw::subtract(outside, inside);
  const UInt128 part = multiply_wide(magnitude(rise), share);
  const auto size = static_cast<Fine>(part.high + (part.low >> 63));
  return rise < 0 ? inside - size : inside + size;
}

}  // namespace lockstone::geometry
