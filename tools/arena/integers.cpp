#include "tools/arena/integers.h"

#include <utility>

#include <lockstone/quat.h>

namespace lockstone::arena {

Vec3<Unit> direction_of(std::int16_t yaw) {
  // 2π · 2^27 raw angle units make a turn of 2^16.
  constexpr std::int64_t k_turn = 843314857;
  const Angle angle = Angle::from_raw(static_cast<std::int32_t>((yaw * k_turn) / 65536));
  // A rotation about +y turns x towards −z, headings turn the other way.
  return to_matrix(from_axis_angle({{}, Unit::from_integer(1), {}}, -angle)).x;
}

std::int16_t yaw_of(std::int64_t x, std::int64_t z) {
  std::int64_t along = x < 0 ? -x : x;
  std::int64_t across = z < 0 ? -z : z;
  if (along == 0 && across == 0) return 0;
  const bool steep = across > along;
  if (steep) std::swap(along, across);
  // atan(r) ≈ r·(π/4 + 0.273·(1 − r)) for 0 ≤ r ≤ 1, error below 0.22°; in turns of 2^16:
  // r·(8192 + 2847·(1 − r)), with r in 15 fraction bits.
  const std::int64_t ratio = (across << 15) / along;
  std::int64_t turn = (ratio * ((std::int64_t{8192} << 15) + 2847 * (32768 - ratio))) >> 30;
  if (steep) turn = 16384 - turn;
  if (x < 0) turn = 32768 - turn;
  if (z < 0) turn = -turn;
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(turn & 0xffff));
}

}  // namespace lockstone::arena
