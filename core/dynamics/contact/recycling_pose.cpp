#include "core/dynamics/contact/recycling_pose.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/pose_distance.h"
#include "core/dynamics/body/raw_vec3.h"
#include "core/dynamics/state/limits.h"

namespace lockstone {
namespace {

// Fraction bits of the angles of a pose delta.
constexpr int k_turn_bits = 32;

// Steps of lengths within those of positions.
constexpr int k_place_shift = Position::frac_bits - Length::frac_bits;

// From the recycling pose's place to the body's, Q32, with the fraction below a step of Length.
std::int64_t way_of(const BodyRecord& body, int axis) {
  const std::int64_t now = body.position[axis].raw;
  const auto steps = static_cast<std::uint32_t>(now >> k_place_shift) -
                     static_cast<std::uint32_t>(body.recycling_place[axis].raw);
  const std::int64_t remainder = now & ((std::int64_t{1} << k_place_shift) - 1);
  return std::int64_t{static_cast<std::int32_t>(steps)} * (1 << k_place_shift) + remainder;
}

// A position in steps of Length: to nearest, ties to even. So it is the same, but for a
// translation, wherever a world is moved by whole metres, and mirrored in a mirror image.
std::int64_t steps_of(Position position) {
  constexpr std::int64_t k_half = std::int64_t{1} << (k_place_shift - 1);
  const std::int64_t below = position.raw >> k_place_shift;
  const std::int64_t rest = position.raw - below * (1 << k_place_shift);
  return rest > k_half || (rest == k_half && below % 2 != 0) ? below + 1 : below;
}

// Of a record that was loaded and not looked at yet it may be anything.
int scale_of(const BodyRecord& body) {
  return std::clamp<int>(body.scale_exponent, -k_largest_scale_exponent, k_largest_scale_exponent);
}

// 2^metres m, or 2^scales of the body's scale where that is less.
struct RangeBits {
  int metres, scales;
};

Length least_range(const BodyRecord& body, const RangeBits& bits) {
  const int exponent = std::min(bits.metres, scale_of(body) + bits.scales);
  LKS_ASSERT(Length::frac_bits + exponent >= 0);
  return Length::from_raw(std::int32_t{1} << (Length::frac_bits + exponent));
}

// A state in which somebody flipped a bit may have its recycling pose anywhere, for a tick.
std::int64_t within_bits(std::int64_t x, int bits) {
  const std::int64_t most = std::int64_t{1} << bits;
  return std::clamp(x, -most, most);
}

}  // namespace

Vec3<Position> recycling_position(const BodyRecord& body) {
  Vec3<Position> place;
  for (int i = 0; i < 3; ++i)
    place[i].raw = body.position[i].raw - way_of(body, i);
  return place;
}

Length coarse_range(const BodyRecord& body) {
  return least_range(body, {-9, -9});
}

Length wide_range(const BodyRecord& body) {
  return least_range(body, {-6, -3});
}

Length pile_range(const BodyRecord& body, Length inner_radius) {
  LKS_ASSERT(inner_radius >= Length{});
  return std::clamp(inner_radius / 16, coarse_range(body), wide_range(body));
}

bool is_near_recycling_pose(const BodyRecord& body, Length range) {
  LKS_ASSERT(range > Length{} && range <= wide_range(body));
  // A place is rounded to a step of lengths.
  constexpr std::int64_t k_two_steps = std::int64_t{1} << (k_place_shift + 1);
  const std::int64_t way = std::max(std::int64_t{range.raw} * (1 << k_place_shift), k_two_steps);
  // Turning by θ moves a surface by θ · scale, and a component of the orientation by θ/2.
  constexpr int k_turn_shift = Unit::frac_bits - 1 - Length::frac_bits;
  const std::int64_t turn = std::max(
      raw::scale_binary(std::int64_t{range.raw}, k_turn_shift - scale_of(body)), std::int64_t{1});
  return is_within(3, way, [&](int i) { return way_of(body, i); }) &&
         is_turned_within(turn, body.orientation, body.recycling_orientation);
}

void set_recycling_pose(BodyRecord& body) {
  for (int i = 0; i < 3; ++i) {
    const std::int64_t steps = steps_of(body.position[i]);
    body.recycling_place[i].raw = static_cast<std::int32_t>(static_cast<std::uint32_t>(steps));
  }
  body.recycling_orientation = body.orientation;
}

PoseDelta pose_delta_of(const BodyRecord& body) {
  PoseDelta delta;
  for (int i = 0; i < 3; ++i) {
    delta.way[static_cast<std::size_t>(i)] =
        static_cast<std::int32_t>(within_bits(way_of(body, i), 27));
  }
  const Quat& then = body.recycling_orientation;
  if (body.orientation == then) return delta;
  // The vector of now · then*, of which the part then · then* is none. Q60, halved.
  const std::int64_t x = within_bits(std::int64_t{body.orientation.x.raw} - then.x.raw, 27);
  const std::int64_t y = within_bits(std::int64_t{body.orientation.y.raw} - then.y.raw, 27);
  const std::int64_t z = within_bits(std::int64_t{body.orientation.z.raw} - then.z.raw, 27);
  const std::int64_t w = within_bits(std::int64_t{body.orientation.w.raw} - then.w.raw, 27);
  const std::int64_t half[] = {x * then.w.raw - w * then.x.raw - y * then.z.raw + z * then.y.raw,
                               y * then.w.raw - w * then.y.raw - z * then.x.raw + x * then.z.raw,
                               z * then.w.raw - w * then.z.raw - x * then.y.raw + y * then.x.raw};
  for (std::size_t i = 0; i < 3; ++i)
    delta.turn[i] =
        static_cast<std::int32_t>(within_bits(raw::round_shift(half[i], 59 - k_turn_bits), 29));
  return delta;
}

void shift_manifold(const PoseDelta& a, const PoseDelta& b, Manifold& manifold) {
  LKS_ASSERT(manifold.count >= 0 && manifold.count <= k_max_manifold_points);
  const Vec3<Unit>& n = manifold.normal;
  // n × turn, Q32: n · (turn × r) = r · (n × turn).
  const auto across = [&](const PoseDelta& delta) -> RawVec3 {
    const auto& turn = delta.turn;
    const auto part = [](std::int64_t x) { return raw::round_shift(x, Unit::frac_bits); };
    return {part(std::int64_t{n.y.raw} * turn[2] - std::int64_t{n.z.raw} * turn[1]),
            part(std::int64_t{n.z.raw} * turn[0] - std::int64_t{n.x.raw} * turn[2]),
            part(std::int64_t{n.x.raw} * turn[1] - std::int64_t{n.y.raw} * turn[0])};
  };
  const auto along = [](const RawVec3& v, const Vec3<Length>& r) {
    return v[0] * r.x.raw + v[1] * r.y.raw + v[2] * r.z.raw;
  };
  const RawVec3 across_a = across(a), across_b = across(b);
  std::int64_t way = 0;  // Q62, then that of an angle times a length
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    way += n[axis].raw * (std::int64_t{b.way[i]} - a.way[i]);
  }
  way >>= 62 - k_turn_bits - Length::frac_bits;
  for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i) {
    ManifoldPoint& point = manifold.points[i];
    const std::int64_t by = way + along(across_b, point.anchor_b) - along(across_a, point.anchor_a);
    point.separation.raw = raw::saturate<std::int32_t>(
        point.separation.raw +
        raw::round_shift(by, k_turn_bits + Length::frac_bits - Displacement::frac_bits));
  }
}

}  // namespace lockstone
