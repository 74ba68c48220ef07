#include "tools/arena/motion.h"

#include "tools/arena/integers.h"

namespace lockstone::arena {

Vec3<SolverVelocity> shortened(const Vec3<SolverVelocity>& velocity, SolverVelocity limit) {
  // Components are below 2^31, so that each half square fits 61 bits and their sum 63.
  const auto square = [](SolverVelocity v) {
    return static_cast<std::uint64_t>(std::int64_t{v.raw} * v.raw) >> 1;
  };
  const std::uint64_t sum = square(velocity.x) + square(velocity.y) + square(velocity.z);
  const auto bound = static_cast<std::uint64_t>(std::int64_t{limit.raw} * limit.raw) >> 1;
  if (sum <= bound) return velocity;
  // The root of the halved sum, times √2 ≈ 46341/32768.
  const std::int64_t length = std::int64_t{integer_sqrt(sum)} * 46341 / 32768 + 1;
  const auto scale = [&](SolverVelocity v) {
    const std::int64_t product = std::int64_t{v.raw} * limit.raw;
    return SolverVelocity::from_raw(static_cast<std::int32_t>(raw::round_divide(product, length)));
  };
  return {scale(velocity.x), scale(velocity.y), scale(velocity.z)};
}

Vec3<Length> offset_between(const Vec3<Position>& a, const Vec3<Position>& b) {
  constexpr Position k_far = Position::from_integer(2000);
  const Vec3<Position> offset = b - a;
  return {rounded<Length>(clamp(offset.x, -k_far, k_far)),
          rounded<Length>(clamp(offset.y, -k_far, k_far)),
          rounded<Length>(clamp(offset.z, -k_far, k_far))};
}

std::int64_t squared_raw(const Vec3<Length>& offset) {
  std::int64_t sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t coarse = offset[axis].raw / 256;  // 12 fraction bits: 0.24 mm
    sum += coarse * coarse;
  }
  return sum;
}

}  // namespace lockstone::arena
