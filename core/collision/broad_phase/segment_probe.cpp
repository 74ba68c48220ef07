#include "core/collision/broad_phase/segment_probe.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/numeric/q50.h"

namespace lockstone {
namespace {

// To bounds coordinates, downward.
std::int64_t to_bounds(Position x) {
  return x.raw >> (Position::frac_bits - BoundsCoordinate::frac_bits);
}

// Roundings of middle, way and half extents together stay below this, in bounds coordinates.
constexpr std::int64_t k_slack = 3;

}  // namespace

Vec3<Position> along(const Vec3<Position>& origin, const Vec3<Length>& translation, Unit fraction) {
  const auto go = [&](Position start, Length step) {
    return start + Position::from_raw(raw::round_shift((step * fraction).raw, 18));
  };
  return {go(origin.x, translation.x), go(origin.y, translation.y), go(origin.z, translation.z)};
}

SegmentProbe::SegmentProbe(const Vec3<Position>& origin, const Vec3<Length>& translation,
                           const Vec3<Length>& reach)
    : origin_(origin), translation_(translation), reach_(reach) {
  for (int i = 0; i < 3; ++i)
    half_[i] = to_bounds(rounded<Position>(reach[i])) + 1;
  set(translation);
}

void SegmentProbe::shorten(Unit fraction) {
  LKS_ASSERT(fraction >= Unit{} && fraction <= Unit::from_integer(1));
  const auto part = [&](Length x) { return rounded<Length>(x * fraction); };
  set({part(translation_.x), part(translation_.y), part(translation_.z)});
}

void SegmentProbe::set(const Vec3<Length>& translation) {
  for (int i = 0; i < 3; ++i) {
    const Position start = origin_[i];
    const Position end = start + rounded<Position>(translation[i]);
    const Position reach = rounded<Position>(reach_[i]) + Position::from_raw(1 << 13);
    swept_.lower[i] = round_down(min(start, end) - reach);
    swept_.upper[i] = round_up(max(start, end) + reach);
    middle_[i] = to_bounds(start) + to_bounds(end);
    way_[i] = to_bounds(rounded<Position>(translation[i]));
    LKS_ASSERT(swept_.lower[i] <= swept_.upper[i]);
    LKS_ASSERT(std::abs(way_[i]) <= std::int64_t{1} << 20);  // which `meets` relies on
  }
  bool is_short = true;
  for (int i = 0; i < 3; ++i)
    is_short = is_short && 4 * std::abs(way_[i]) <= half_[i];
  bounds_suffice_ = is_short || std::ranges::count(way_, 0) >= 2;
}

// Separating axes of a segment and a box: the box's axes, then their cross products with the
// segment (C. Ericson, "Real-Time Collision Detection", 5.3.3). |way| ≤ 2^20, the other lengths
// after the first test ≤ 2^33: products fit.
bool SegmentProbe::meets(const Bounds& bounds) const {
  if (!overlap(swept_, bounds)) return false;
  if (bounds_suffice_) return true;
  std::int64_t offset[3], extent[3];
  for (int i = 0; i < 3; ++i) {
    const std::int64_t low = bounds.lower[i].raw, high = bounds.upper[i].raw;
    offset[i] = middle_[i] - (low + high);                // twice the distance of the middles
    extent[i] = (high - low) + 2 * (half_[i] + k_slack);  // twice the half extent
    LKS_ASSERT(extent[i] > 0 && std::abs(offset[i]) <= std::int64_t{1} << 33);
  }
  for (int i = 0; i < 3; ++i) {
    const int j = i == 2 ? 0 : i + 1, k = 3 - i - j;
    const std::int64_t apart = geometry::magnitude_of(offset[j] * way_[k] - offset[k] * way_[j]);
    const std::int64_t reach = extent[j] * (geometry::magnitude_of(way_[k]) + 1) +
                               extent[k] * (geometry::magnitude_of(way_[j]) + 1);
    const std::int64_t rounding =
        geometry::magnitude_of(offset[j]) + geometry::magnitude_of(offset[k]);
    if (apart > reach + rounding) return false;
  }
  return true;
}

}  // namespace lockstone
