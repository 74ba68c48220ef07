// Mass distribution of an asset that dynamic bodies can have.
#pragma once

#include <algorithm>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/numeric/q50.h"
#include "core/math/block_float.h"

namespace lockstone::geometry {

/// Fraction bits of the tensors that moments are computed in.
inline constexpr int k_tensor_bits = 60;

/// A moment of inertia over mass and squared length. Where most of the mass is within a hundredth
/// of the radius, 30 bits of it would tell little.
using Moment = Fixed<Scalar, std::int64_t, k_tensor_bits>;

/// Of uniform density. Lengths err by at most half their last place, moments by 1e-6 relative.
struct Solid {
  Vec3<Length> centre{};  ///< of mass, in the asset's frame
  RawVec remainder{};     ///< the part of the centre that rounding took, fine
  Quat axes{};            ///< takes the principal axes to the asset's: columns are their directions
  Mat3 to_axes{};         ///< the transposed matrix of that
  BlockFloat volume{};    ///< m³, relative error ≤ 2^-30
  Vec3<Moment> inertia{};  ///< principal moments / (mass · s²), each in (0, 1]
  int scale_exponent = 0;  ///< s = 2^k m, the first power of two ≥ radius; −10 … 10
  Length radius{};         ///< of the smallest sphere about the centre of mass that holds all
  Length inner_radius{};   ///< of the largest sphere about it that the solid holds; 0 when outside

  void set_axes(const Quat& to) {
    axes = to;
    to_axes = transposed(to_matrix(to));
  }
};

/// A principal moment within its range: at least one step, or a needle's about its own axis
/// vanish.
[[nodiscard]] constexpr Moment to_moment(std::int64_t x) {
  return Moment::from_raw(std::clamp<std::int64_t>(x, 1, std::int64_t{1} << k_tensor_bits));
}

/// To nearest.
[[nodiscard]] constexpr Unit to_unit(Moment moment) {
  constexpr int shift = k_tensor_bits - Unit::frac_bits;
  return Unit::from_raw(static_cast<std::int32_t>(raw::round_shift(moment.raw, shift)));
}

[[nodiscard]] constexpr Moment to_moment(Unit x) {
  return to_moment(std::int64_t{x.raw} << (k_tensor_bits - Unit::frac_bits));
}

}  // namespace lockstone::geometry
