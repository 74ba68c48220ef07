// Mass distribution of an asset that dynamic bodies can have.
#pragma once

#include <algorithm>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/math/block_float.h"

namespace lockstone::geometry {

/// Of uniform density. Lengths err by at most half their last place, moments by 1e-6 relative.
struct Solid {
  Vec3<Length> centre{};  ///< of mass, in the asset's frame
  Quat axes{};            ///< takes the principal axes to the asset's: columns are their directions
  BlockFloat volume{};    ///< m³, relative error ≤ 2^-30
  Vec3<Unit> inertia{};   ///< principal moments / (mass · s²), each in (0, 1]
  int scale_exponent = 0;  ///< s = 2^k m, the first power of two ≥ radius; −10 … 10
  Length radius{};         ///< of the smallest sphere about the centre of mass that holds all
  Length inner_radius{};   ///< of the largest sphere about it that the solid holds; 0 when outside
};

/// Fraction bits of the tensors that moments are computed in.
inline constexpr int k_tensor_bits = 60;

/// A moment with k_tensor_bits, rounded: at least one step, lest a needle's about its own axis
/// vanish.
[[nodiscard]] constexpr Unit to_moment(std::int64_t x) {
  const std::int64_t rounded = raw::round_shift(x, k_tensor_bits - Unit::frac_bits);
  return {
      static_cast<std::int32_t>(std::clamp<std::int64_t>(rounded, 1, Unit::from_integer(1).raw))};
}

}  // namespace lockstone::geometry
