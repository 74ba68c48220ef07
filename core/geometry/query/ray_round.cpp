#include "core/geometry/query/ray_round.h"

#include <algorithm>
#include <bit>

#include "core/geometry/numeric/segment.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_fraction_bits = 60;

/// Lanes up to this size have a squared sum below 2^63: ⌊2^30.5⌋.
constexpr std::int64_t k_max_lane = 1518500249;

std::int64_t largest_lane(const RawVec& v) {
  return std::max({magnitude_of(v.x), magnitude_of(v.y), magnitude_of(v.z)});
}

/// The least right shift that brings `largest` below k_max_lane.
int shift_for(std::int64_t largest) {
  const int shift =
      std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(largest))) - 31);
  return raw::round_shift(largest, shift) > k_max_lane ? shift + 1 : shift;
}

std::int64_t dot(const RawVec& a, const RawVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// c · 2^shift / denominator with 60 fraction bits, or a miss when it exceeds 1.
RoundHit fraction_of(std::int64_t c, int shift, std::uint64_t denominator) {
  const auto size = static_cast<std::uint64_t>(c);
  if (shift > std::countl_zero(size)) return {};
  const UInt128 scaled_up = UInt128{0, size} << (k_fraction_bits + shift);
  if (scaled_up > UInt128{0, denominator} << k_fraction_bits) return {};
  return {true, static_cast<std::int64_t>(round_divide(scaled_up, denominator))};
}

/// origin + fraction · translation, fine.
RawVec point_on(const RawVec& origin, const RawVec& translation, std::int64_t fraction) {
  const auto part = [fraction](std::int64_t lane) {
    return saturated_product(lane, fraction, k_fraction_bits);
  };
  return origin + RawVec{part(translation.x), part(translation.y), part(translation.z)};
}

ShapeRayHit hit_at(std::int64_t fraction, const RawVec& outward) {
  const std::int64_t rounded = raw::round_shift(fraction, k_fraction_bits - Unit::frac_bits);
  return {true, Unit::from_raw(static_cast<std::int32_t>(rounded)),
          direction_of(outward.x, outward.y, outward.z)};
}

/// v without its part along the axis.
RawVec across(const RawVec& v, const Vec3<Unit>& axis) {
  return v - along(axis, geometry::dot(v, axis));
}

struct RoundCandidate {
  RoundHit at;
  RawVec outward;  ///< from the core to the point
};

void take_earlier(RoundCandidate& best, const RoundCandidate& other) {
  if (!other.at.hit) return;
  if (!best.at.hit || other.at.fraction < best.at.fraction) best = other;
}

RoundCandidate meet_ball(const RawVec& origin, const RawVec& translation, Fine radius) {
  const RoundHit at = first_meeting(origin, translation, radius);
  return {at, point_on(origin, translation, at.fraction)};
}

/// The cylinder between the balls; a hit beyond its ends belongs to a ball.
RoundCandidate meet_side(const Segment& core, const RawVec& origin, const RawVec& translation,
                         Fine radius) {
  constexpr Fine seam = Fine{1} << (k_fine_bits - 30);  // no ray slips between side and ball
  const RawVec flat_origin = across(origin, core.axis);
  const RawVec flat_translation = across(translation, core.axis);
  const RoundHit at = first_meeting(flat_origin, flat_translation, radius);
  if (!at.hit) return {};
  const RawVec point = point_on(origin, translation, at.fraction);
  if (magnitude_of(geometry::dot(point, core.axis)) > fine(core.half) + seam) return {};
  return {at, point_on(flat_origin, flat_translation, at.fraction)};
}

bool starts_inside(const Segment& core, const RawVec& origin, Fine radius) {
  const RawVec gap = origin - point_at(core, closest_parameter(core, origin));
  return norm(gap.x, gap.y, gap.z) <= static_cast<std::uint64_t>(radius);
}

}  // namespace

RoundHit first_meeting(const RawVec& origin, const RawVec& translation, Fine radius) {
  const int origin_shift = shift_for(std::max(largest_lane(origin), radius));
  const int translation_shift = shift_for(largest_lane(translation));
  const RawVec o = shifted(origin, origin_shift);
  const RawVec t = shifted(translation, translation_shift);
  const std::int64_t r = raw::round_shift(radius, origin_shift);
  // a·f² + 2b·f + c = 0; the smaller root, written so that nothing cancels: c / (−b + √(b² − ac)).
  const std::int64_t a = dot(t, t);
  const std::int64_t b = dot(o, t);
  const std::int64_t c = dot(o, o) - r * r;
  if (c <= 0) return {true, 0};
  if (b >= 0) return {};
  const Int128 discriminant = multiply_wide(b, b) - multiply_wide(a, c);
  if (discriminant.negative()) return {};
  const std::uint64_t denominator = magnitude(b) + isqrt128(discriminant.bits());
  return fraction_of(c, origin_shift - translation_shift, denominator);
}

ShapeRayHit cast_ray_at_sphere(Length radius, const Vec3<Length>& origin,
                               const Vec3<Length>& translation) {
  const RawVec start = fine(origin);
  const std::uint64_t square = norm_squared(origin);
  const auto r = static_cast<std::uint64_t>(radius.raw);
  if (square <= r * r) return {true, {}, {}};
  const RoundHit at = first_meeting(start, fine(translation), fine(radius));
  if (!at.hit) return {};
  return hit_at(at.fraction, point_on(start, fine(translation), at.fraction));
}

ShapeRayHit cast_ray_at_capsule(const Shape& capsule, const Mat3& rotation,
                                const Vec3<Length>& origin, const Vec3<Length>& translation) {
  const Segment core = core_segment(capsule, rotation, {});
  const Fine radius = fine(capsule.size.x);
  const RawVec start = fine(origin);
  const RawVec way = fine(translation);
  if (starts_inside(core, start, radius)) return {true, {}, {}};
  const RawVec end = along(core.axis, core.half);
  RoundCandidate best = meet_side(core, start, way, radius);
  take_earlier(best, meet_ball(start - end, way, radius));
  take_earlier(best, meet_ball(start + end, way, radius));
  if (!best.at.hit) return {};
  return hit_at(best.at.fraction, best.outward);
}

}  // namespace lockstone::geometry
