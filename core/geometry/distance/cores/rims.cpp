#include "core/geometry/distance/cores/rims.h"

#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

constexpr std::int64_t k_steps = std::int64_t{1} << k_rim_bits;

/// Turned into (−π, π].
Angle wrapped(std::int64_t angle) {
  angle %= k_full_turn;
  if (angle > k_full_turn / 2) angle -= k_full_turn;
  if (angle <= -k_full_turn / 2) angle += k_full_turn;
  return Angle::from_raw(static_cast<std::int32_t>(angle));
}

}  // namespace

// Sine and cosine are rounded to 30 bits; a radius divided by their norm, 1 + e/2 for e of less
// than 2^-28, keeps neighbours on one circle: the line between them has the normal of the circle.
RawVec rim_point(const Rims& rims, int rim, Angle angle, Fine radius) {
  const SinCos turn = sin_cos(angle);
  const std::int64_t excess = (turn.cos * turn.cos).raw + (turn.sin * turn.sin).raw -
                              (std::int64_t{1} << (2 * Unit::frac_bits));
  const Int128 half = round_shift(multiply_wide(radius, excess), 2 * Unit::frac_bits + 1);
  const Fine kept = radius - saturate_to_int64(half);
  return rims.centres[static_cast<std::size_t>(rim)] + along(rims.u, scaled(kept, turn.cos.raw)) +
         along(rims.v, scaled(kept, turn.sin.raw));
}

RawVec rim_point(const Rims& rims, int index) {
  const int rim = index >> k_rim_bits;
  const Length radius = rims.radii[static_cast<std::size_t>(rim)];
  std::int64_t step = index & (k_steps - 1);
  if (step > k_steps / 2) step -= k_steps;
  return rim_point(rims, rim, wrapped(raw::round_shift(step * k_full_turn, k_rim_bits)),
                   fine(radius));
}

Angle rim_angle(const Rims& rims, const RawVec& direction) {
  const WideVec flat{wide_dot(direction, raws_of(rims.u)), wide_dot(direction, raws_of(rims.v)),
                     Int128{}};
  const RawVec cut = truncated(flat, 62);
  return atan2_raw(cut.y, cut.x);
}

int farthest_rim_vertex(const Rims& rims, const RawVec& direction) {
  LKS_ASSERT(rims.count == 2);
  const std::int64_t turns = std::int64_t{rim_angle(rims, direction).raw} * k_steps;
  const std::int64_t step = round_divide(Int128::from(turns), k_full_turn) & (k_steps - 1);
  const int base = static_cast<int>(step);
  // Rims of one radius differ by their centres at every angle; else the second is an apex.
  const bool cone = rims.radii[1] == Length{};
  LKS_ASSERT(cone || rims.radii[1] == rims.radii[0]);
  const RawVec up = rims.centres[1] - (cone ? rim_point(rims, base) : rims.centres[0]);
  if (!is_positive(wide_dot(direction, up))) return base;
  return 1 << k_rim_bits | (cone ? 0 : base);
}

RawVec around_rim(const Rims& rims, int rim, Angle angle, int side) {
  // 1 / cos(π/32) and four steps for the rounding of sine and cosine, 30 fraction bits
  constexpr std::int32_t k_outward = 1078937206;
  const Fine radius = fine(rims.radii[static_cast<std::size_t>(rim)]);
  const std::int64_t turned = (2 * side + 1) * k_full_turn / (2 * k_rim_sides);
  return rim_point(rims, rim, wrapped(angle.raw + turned), scaled(radius, k_outward));
}

}  // namespace lockstone::geometry
