#include "core/dynamics/contact/contact_prepare.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include <lockstone/assert.h>

#include "core/dynamics/body/mass_share.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

using lanes::PrepareInput;

constexpr std::int64_t k_one_q30 = std::int64_t{1} << 30;

// 1/count, Q30.
constexpr std::array<std::int32_t, 5> k_one_over = {0, 1 << 30, 1 << 29, ((1 << 30) + 1) / 3,
                                                    1 << 28};

// Contacts are as stiff as a single iteration of a substep holds still, 1/8 of its rate (at 3/16
// cards and pyramids tremble), and heavily overdamped, so that penetration is pushed out without
// adding energy.
constexpr std::int64_t contact_hertz(std::int64_t substep_rate) {
  return substep_rate / 8;
}
constexpr std::int32_t k_contact_damping_ratio = 10;

// With ω = 2π·hertz: a1 = 2ζ + hω, a2 = hω·a1, a3 = 1/(1 + a2);
// bias rate = ω/a1, mass scale = a2·a3 = 1 − a3.
Softness make_softness(std::int64_t hertz, std::int64_t substep_rate) {
  LKS_ASSERT(hertz > 0 && substep_rate > 0);
  const std::int64_t h_omega_q28 = raw::round_divide(k_two_pi_q28 * hertz, substep_rate);
  const std::int64_t a1_q28 = (std::int64_t{2 * k_contact_damping_ratio} << 28) + h_omega_q28;
  const std::int64_t a2_q24 = raw::round_shift((h_omega_q28 >> 2) * (a1_q28 >> 4), 26);
  const std::int64_t one_plus_q24 = (std::int64_t{1} << 24) + a2_q24;
  const std::int64_t a3_q30 = raw::round_divide(std::int64_t{1} << 54, one_plus_q24);
  const std::int64_t omega_q20 = raw::round_shift(k_two_pi_q28 * hertz, 8);
  const std::int64_t rate_q20 = raw::round_divide(omega_q20 << 20, a1_q28 >> 8);
  LKS_ASSERT(a3_q30 > 0 && a3_q30 <= k_one_q30);
  LKS_ASSERT(rate_q20 > 0 && rate_q20 <= INT32_MAX);
  return {static_cast<std::int32_t>(rate_q20), static_cast<std::int32_t>(k_one_q30 - a3_q30)};
}

// In a pinched island, points that overlap by more than this are pinched; at twice this overlap, a
// row keeps no more than half of its impulse from one iteration to the next.
constexpr Displacement k_pinched = Displacement::from_ratio(3, 1000);
constexpr std::int32_t k_kept_of_pinched = 1 << 29;

// The share of its impulse that a soft row keeps in a pinched island. Between two bodies that close
// in without end, a heavily damped spring pushes without limit, until the body between them slips
// out and is thrown away. A pinched contact gives way instead.
std::int32_t kept_share(std::int32_t keep, const Manifold& manifold) {
  LKS_ASSERT(keep >= 0 && keep <= k_one_q30);
  Displacement least = manifold.points[0].separation;
  for (std::size_t i = 1; i < static_cast<std::size_t>(manifold.count); ++i)
    least = min(least, manifold.points[i].separation);
  const std::int64_t beyond = -std::int64_t{least.raw} - k_pinched.raw;
  if (beyond <= 0) return keep;
  const std::int64_t most = keep - std::min(keep, k_kept_of_pinched);
  const std::int64_t lost = most * std::min<std::int64_t>(beyond, k_pinched.raw);
  return keep - static_cast<std::int32_t>(raw::round_divide(lost, k_pinched.raw));
}

std::int32_t bounded_impulse(const ContactPointRecord& point) {
  return std::clamp(point.normal_impulse.raw, 0, lanes::k_most_impulse);
}

// The record's point of that feature; its count where there is none.
std::size_t find_point(const ContactRecord& record, std::size_t like, std::uint32_t feature) {
  if (like < record.count && record.points[like].feature == feature) return like;
  std::size_t place = 0;
  while (place < record.count && record.points[place].feature != feature)
    ++place;
  return place;
}

// Divides the impulses of points that are gone among the new ones: where boxes fall flush onto each
// other, points change names from tick to tick, and contacts that forgot their impulses each time
// would rattle.
void share_out(std::int64_t left, std::uint32_t fresh, PrepareInput& out) {
  LKS_ASSERT(left > 0 && fresh != 0);
  const std::int64_t each =
      std::min<std::int64_t>(left / std::popcount(fresh), lanes::k_most_impulse);
  for (std::size_t i = 0; i < lanes::k_block_points; ++i)
    if ((fresh >> i & 1) != 0) out.impulses[i] = static_cast<std::int32_t>(each);
}

// Warm starts each point with the impulse that the point of the same feature had at the end of the
// last tick. Returns whether the record has all points already, in their places.
bool fill_points(const ContactInput& in, PrepareInput& out) {
  const auto count = static_cast<std::size_t>(in.manifold.count);
  LKS_ASSERT(count <= lanes::k_block_points && in.record.count <= lanes::k_block_points);
  bool kept = in.record.count == count;
  std::int64_t left = 0;
  std::uint32_t fresh = 0;
  for (std::size_t i = 0; i < in.record.count; ++i)
    left += bounded_impulse(in.record.points[i]);
  out.impulses = {};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = find_point(in.record, i, in.manifold.points[i].feature);
    kept = kept && place == i;
    if (place == in.record.count) {
      fresh |= 1U << i;
      continue;
    }
    out.impulses[i] = bounded_impulse(in.record.points[place]);
    left -= out.impulses[i];
  }
  for (std::size_t i = count; i < lanes::k_block_points; ++i)
    kept = kept && in.record.points[i] == ContactPointRecord{};
  out.mean_impulse = std::clamp(in.record.mean_impulse.raw, 0, lanes::k_most_impulse);
  if (fresh != 0 && left > 0) share_out(left, fresh, out);
  out.count = in.manifold.count;
  out.one_over_count = k_one_over[count];
  return kept;
}

// The scale of the smaller of the bodies that turn.
int scale_exponent_of(const SolverBody& a, const SolverBody& b) {
  if (a.turns() && b.turns()) return std::min(a.scale_exponent, b.scale_exponent);
  if (a.turns()) return a.scale_exponent;
  if (b.turns()) return b.scale_exponent;
  return std::max(a.scale_exponent, b.scale_exponent);
}

// Rolling is resisted by arm/ℓ of the normal impulse.
void fill_rolling(const ContactInput& in, int scale_exponent, PrepareInput& out) {
  out.rolling = {};
  out.rolling_limit = 0;
  if (in.surface.rolling_arm == Length{}) return;
  out.rolling_limit = raw::saturate<std::int32_t>(
      raw::scale_binary(std::int64_t{in.surface.rolling_arm.raw}, 8 - scale_exponent));
  if (out.rolling_limit == 0) return;
  LKS_ASSERT(out.rolling_limit > 0);
  const Vec3<SolverVelocity>& rolling = in.record.rolling_impulse;
  out.rolling = {rolling.x.raw, rolling.y.raw, rolling.z.raw};
}

// The share of a push along an axis that goes to bodies which are locked along it.
std::int32_t locked_along(const ContactInput& in, int axis, std::int32_t share_b) {
  const std::int64_t a = in.body_a.is_locked(axis) ? k_one_q30 - share_b : 0;
  const std::int64_t b = in.body_b.is_locked(axis) ? share_b : 0;
  return static_cast<std::int32_t>(a + b);
}

}  // namespace

const std::int32_t* geometry_of(const Manifold& manifold) {
  static_assert(sizeof(Manifold) == sizeof(lanes::ManifoldGeometry) &&
                offsetof(Manifold, points) == 16 && sizeof(ManifoldPoint) == 32 &&
                offsetof(ManifoldPoint, anchor_b) == 12 &&
                offsetof(ManifoldPoint, separation) == 24);
  return &manifold.normal.x.raw;
}

ContactSoftness ContactSoftness::of(const TimeStep& step) {
  const std::int64_t rate = step.substep_rate();
  const std::int64_t hertz = contact_hertz(rate);
  return {make_softness(hertz, rate), make_softness(2 * hertz, rate)};
}

bool fill_source(const ContactInput& in, const ContactSoftness& softness, PrepareInput& out) {
  const SolverBody& a = in.body_a;
  const SolverBody& b = in.body_b;
  const int pair_exponent = std::max(a.inverse_inertia.exponent, b.inverse_inertia.exponent);
  const int scale_exponent = scale_exponent_of(a, b);
  const bool immovable = !a.is_pushed() || !b.is_pushed();
  const Softness& soft = immovable ? softness.against_immovable : softness.between_moving;
  const auto scale = [&](const SolverBody& body) {
    if (!body.turns()) return 0;
    return (1 << 30) >> std::min(body.scale_exponent - scale_exponent, 31);
  };
  const auto inverse_scale = [](const SolverBody& body) {
    return body.turns() ? 1 << (11 - body.scale_exponent) : 0;
  };
  const Vec3<SolverVelocity>& friction = in.record.friction_impulse;
  out.friction = {friction.x.raw, friction.y.raw, friction.z.raw};
  out.twist = in.record.twist_impulse.raw;
  const bool kept = fill_points(in, out);
  out.share_b = share_of_b(a.inverse_mass, b.inverse_mass);
  out.coefficient = in.surface.friction.raw;
  out.scale_a = scale(a);
  out.scale_b = scale(b);
  out.bias_rate = soft.bias_rate;
  out.keep = in.is_pinched ? kept_share(soft.mass_scale, in.manifold) : soft.mass_scale;
  out.inertia_a = 1 << (12 - pair_exponent + a.inverse_inertia.exponent);
  out.inertia_b = 1 << (12 - pair_exponent + b.inverse_inertia.exponent);
  out.inverse_scale_a = inverse_scale(a);
  out.inverse_scale_b = inverse_scale(b);
  out.offset_shift = 20 + scale_exponent;
  out.shift = 28 - pair_exponent;
  fill_rolling(in, scale_exponent, out);
  LKS_ASSERT(out.share_b >= 0);
  LKS_ASSERT(out.inertia_a >= 1 && out.inertia_a <= 1 << 12);
  LKS_ASSERT(out.inertia_b >= 1 && out.inertia_b <= 1 << 12);
  LKS_ASSERT(out.offset_shift >= 10 && out.offset_shift <= 31);
  LKS_ASSERT(out.shift >= 16 && out.shift <= 28);
  const Vec3<SolverVelocity>& drive = in.surface.drive;
  out.drive = {drive.x.raw, drive.y.raw, drive.z.raw};
  out.twist_drive = raw::saturate<std::int32_t>(
      raw::scale_binary(std::int64_t{in.surface.twist_drive.raw}, scale_exponent));
  const bool is_driven = (out.drive[0] | out.drive[1] | out.drive[2] | out.twist_drive) != 0;
  const bool is_plain = a.is_plain && b.is_plain && !is_driven && out.rolling_limit == 0;
  out.kind = is_plain ? 0 : lanes::k_special_lane;
  out.locked = {};
  out.is_elastic = in.surface.restitution.raw != 0 ? 1 : 0;
  if (a.locked == 0 && b.locked == 0) return kept;
  for (int axis = 0; axis < 3; ++axis)
    out.locked[static_cast<std::size_t>(axis)] = locked_along(in, axis, out.share_b);
  return kept;
}

void across(const lanes::ManifoldBlock& block, std::size_t lane, std::int64_t word,
            Vec3<SolverVelocity>& out) {
  LKS_ASSERT(lane < lanes::k_block_lanes);
  const auto low = [](std::int64_t x) { return static_cast<std::int32_t>(x); };
  const auto high = [](std::int64_t x) { return static_cast<std::int32_t>(x >> 32); };
  const std::int64_t along_t = static_cast<std::int32_t>(word),
                     along_b = static_cast<std::int32_t>(word >> 32);
  const std::int64_t axes[3][2] = {{high(block.axes[1][lane]), low(block.axes[3][lane])},
                                   {low(block.axes[2][lane]), high(block.axes[3][lane])},
                                   {high(block.axes[2][lane]), low(block.axes[4][lane])}};
  for (int i = 0; i < 3; ++i) {
    const std::int64_t sum = along_t * axes[i][0] + along_b * axes[i][1];
    out[i].raw = raw::saturate<std::int32_t>(raw::round_shift(sum, 30));
  }
}

}  // namespace lockstone
