#include "core/geometry/convex/compound_solid.h"

#include <algorithm>

#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/numeric/q50.h"
#include "core/math/principal_axes.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

using Solids = std::span<const PlacedSolid>;

/// Weights as whole numbers below 2^54: the sum of 256 of them fits.
class Weights {
 public:
  explicit Weights(Solids solids) {
    for (const PlacedSolid& solid : solids)
      exponent_ = std::max<int>(exponent_, solid.weight.exponent);
    for (const PlacedSolid& solid : solids)
      total_ += of(solid);
  }

  [[nodiscard]] std::int64_t of(const PlacedSolid& solid) const {
    const int below = exponent_ - solid.weight.exponent;
    return below > 60 ? 0 : (std::int64_t{solid.weight.mantissa} << 23) >> below;
  }
  [[nodiscard]] std::int64_t total() const { return total_; }
  [[nodiscard]] BlockFloat total_volume() const {
    return block_float(static_cast<std::uint64_t>(total_), exponent_ - 23);
  }

 private:
  int exponent_ = -128;
  std::int64_t total_ = 0;
};

/// Of a solid in the common frame, fine.
RawVec centre_of(const PlacedSolid& placed) {
  const Mat3 axes = to_matrix(placed.orientation);
  const Vec3<Length>& c = placed.solid.centre;
  return fine(placed.position) + along(axes.x, c.x) + along(axes.y, c.y) + along(axes.z, c.z) +
         rotate(axes, placed.solid.remainder);
}

RawVec mean_centre(Solids solids, const Weights& weights) {
  RawVec centre;
  for (int axis = 0; axis < 3; ++axis) {
    Int128 moment{};
    for (const PlacedSolid& solid : solids)
      moment = moment + multiply_wide(weights.of(solid), centre_of(solid)[axis]);
    centre[axis] = round_divide(moment, weights.total());
  }
  return centre;
}

/// Rounded up.
Length distance_up(const RawVec& arm) {
  const std::uint64_t distance = norm(arm.x, arm.y, arm.z);
  return Length::from_raw(
      static_cast<std::int32_t>((distance >> k_fine_per_length) + (distance != 0 ? 2 : 0)));
}

/// A solid's tensor about the common centre, in squares of the scale 2^k, 60 bits.
SymMat3<std::int64_t> tensor_about(const PlacedSolid& placed, const RawVec& arm, int k) {
  const Solid& solid = placed.solid;
  const Mat3 frame = multiply(to_matrix(placed.orientation), to_matrix(solid.axes));
  const SymMat3<Unit> own = lockstone::rotate(frame, SymMat3<Unit>{to_unit(solid.inertia.x),
                                                                   to_unit(solid.inertia.y),
                                                                   to_unit(solid.inertia.z),
                                                                   {},
                                                                   {},
                                                                   {}});
  const int smaller = 2 * (k - solid.scale_exponent);
  const auto own_entry = [&](Unit x) {
    const std::int64_t wide = std::int64_t{x.raw} << (k_tensor_bits - Unit::frac_bits);
    return smaller > 60 ? 0 : raw::round_shift(wide, smaller);
  };
  // d_i · d_j of the arm in units of the scale, 40 bits
  const auto product = [&](int i, int j) {
    const auto scaled_arm = [&](int axis) { return raw::round_shift(arm[axis], 10 + k); };
    return saturate_to_int64(
        round_shift(multiply_wide(scaled_arm(i), scaled_arm(j)), 80 - k_tensor_bits));
  };
  const std::int64_t xx = product(0, 0), yy = product(1, 1), zz = product(2, 2);
  return {own_entry(own.xx) + yy + zz,       own_entry(own.yy) + zz + xx,
          own_entry(own.zz) + xx + yy,       own_entry(own.xy) - product(0, 1),
          own_entry(own.xz) - product(0, 2), own_entry(own.yz) - product(1, 2)};
}

SymMat3<std::int64_t> mean_tensor(Solids solids, const Weights& weights, const RawVec& centre,
                                  int k) {
  Int128 sums[6] = {};
  for (const PlacedSolid& solid : solids) {
    const SymMat3<std::int64_t> t = tensor_about(solid, centre_of(solid) - centre, k);
    const std::int64_t entries[6] = {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz};
    for (int i = 0; i < 6; ++i)
      sums[i] = sums[i] + multiply_wide(weights.of(solid), entries[i]);
  }
  const auto mean = [&](int i) { return round_divide(sums[i], weights.total()); };
  return {mean(0), mean(1), mean(2), mean(3), mean(4), mean(5)};
}

}  // namespace

Solid solid_of(const Shape& primitive) {
  Solid solid;
  solid.volume = traits_of(primitive).volume(primitive);
  const Vec3<Unit> inertia = normalized_inertia(primitive);
  solid.inertia = {to_moment(inertia.x), to_moment(inertia.y), to_moment(inertia.z)};
  solid.scale_exponent = scale_exponent(primitive);
  solid.radius = bounding_radius(primitive);
  solid.inner_radius = inner_radius(primitive);
  return solid;
}

Solid combined(Solids solids) {
  const Weights weights(solids);
  const RawVec centre = mean_centre(solids, weights);
  Solid result;
  result.volume = weights.total_volume();
  for (int axis = 0; axis < 3; ++axis) {
    result.centre[axis].raw =
        static_cast<std::int32_t>(raw::round_shift(centre[axis], k_fine_per_length));
  }
  result.remainder = centre - fine(result.centre);
  for (const PlacedSolid& solid : solids) {
    const Length distance = distance_up(centre_of(solid) - fine(result.centre));
    result.radius = max(result.radius, distance + solid.solid.radius);
    result.inner_radius = max(result.inner_radius, solid.solid.inner_radius - distance);
  }
  result.scale_exponent = scale_exponent_of(result.radius);
  const PrincipalAxes principal =
      principal_axes(mean_tensor(solids, weights, centre, result.scale_exponent));
  result.set_axes(principal.axes);
  result.inertia = {to_moment(principal.moments.x), to_moment(principal.moments.y),
                    to_moment(principal.moments.z)};
  return result;
}

}  // namespace lockstone::geometry
