#include "core/math/rotation_log.h"

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

constexpr int k_angle_to_component = RotationComponent::frac_bits - Angle::frac_bits;

}  // namespace

RotationVector rotation_between(const Quat& from, const Quat& to) {
  Quat turn = multiply(to, conjugate(from));
  if (turn.w < Unit{}) turn = {-turn.x, -turn.y, -turn.z, -turn.w};
  const auto sine = static_cast<std::int64_t>(norm(turn.x.raw, turn.y.raw, turn.z.raw));
  if (sine == 0) return {};
  // θ/2 = atan2(sine, w); each component is sine_i / sine · θ.
  const std::int64_t half_angle = atan2_raw(sine, turn.w.raw).raw;
  const auto component = [&](Unit x) {
    const Int128 product = multiply_wide(std::int64_t{x.raw}, half_angle);
    return RotationComponent::from_raw(round_divide(product << (k_angle_to_component + 1), sine));
  };
  return {component(turn.x), component(turn.y), component(turn.z)};
}

bool has_direction(const Quat& q) {
  const auto within = [](Unit x) {  // not by abs: -2 has no opposite
    return x >= Unit::from_ratio(-5, 4) && x <= Unit::from_ratio(5, 4);
  };
  return within(q.x) && within(q.y) && within(q.z) && within(q.w) &&
         (q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w).raw >= (std::int64_t{1} << 40);
}

Quat orientation_of(const Mat3& m) {
  // Four times the squares of x, y, z and w, 30 bits; they sum to 4.
  const std::int64_t one = std::int64_t{1} << Unit::frac_bits;
  const std::int64_t xx = m.x.x.raw, yy = m.y.y.raw, zz = m.z.z.raw;
  const std::int64_t squares[4] = {one + xx - yy - zz, one - xx + yy - zz, one - xx - yy + zz,
                                   one + xx + yy + zz};
  // Four times the products of two of them.
  const std::int64_t xy = std::int64_t{m.x.y.raw} + m.y.x.raw;
  const std::int64_t yz = std::int64_t{m.y.z.raw} + m.z.y.raw;
  const std::int64_t zx = std::int64_t{m.z.x.raw} + m.x.z.raw;
  const std::int64_t wx = std::int64_t{m.y.z.raw} - m.z.y.raw;
  const std::int64_t wy = std::int64_t{m.z.x.raw} - m.x.z.raw;
  const std::int64_t wz = std::int64_t{m.x.y.raw} - m.y.x.raw;
  int greatest = 3;
  for (int i = 0; i < 3; ++i) {
    if (squares[i] > squares[greatest]) greatest = i;
  }
  const std::int64_t rows[4][4] = {{squares[0], xy, zx, wx},
                                   {xy, squares[1], yz, wy},
                                   {zx, yz, squares[2], wz},
                                   {wx, wy, wz, squares[3]}};
  // Twice the greatest component, 30 bits; the others are products over it.
  const auto root = static_cast<std::int64_t>(
      isqrt_rounded(static_cast<std::uint64_t>(squares[greatest]) << Unit::frac_bits));
  Quat q;
  Unit* const components[4] = {&q.x, &q.y, &q.z, &q.w};
  for (int i = 0; i < 4; ++i) {
    const std::int64_t numerator = rows[greatest][i] * (one / 2);
    components[i]->raw = static_cast<std::int32_t>(raw::round_divide(numerator, root));
  }
  return normalized(q.w < Unit{} ? Quat{-q.x, -q.y, -q.z, -q.w} : q);
}

}  // namespace lockstone
