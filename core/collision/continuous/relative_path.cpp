#include "core/collision/continuous/relative_path.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

using geometry::Metres;
using geometry::raws_of;
using geometry::RawVec;

constexpr Metres k_way_rounding = 8;

// Below half a radian: fits 32 bits.
bool is_small(const RawVec& turn) {
  constexpr std::int64_t k_half = std::int64_t{1} << (geometry::k_metre_bits - 1);
  return std::max({std::abs(turn.x), std::abs(turn.y), std::abs(turn.z)}) < k_half;
}

Metres times(Metres x, std::int64_t small_turn) {
  return raw::multiply_shift(x, static_cast<std::int32_t>(small_turn), geometry::k_metre_bits);
}

RawVec cross(const RawVec& turn, const RawVec& v) {
  return {times(v.z, turn.y) - times(v.y, turn.z), times(v.x, turn.z) - times(v.z, turn.x),
          times(v.y, turn.x) - times(v.x, turn.y)};
}

Metres norm_of(const RawVec& v) {
  return static_cast<Metres>(norm(v.x, v.y, v.z));
}

}  // namespace

Position relative_way(const Sweep& a, const Sweep& b, Length radius) {
  LKS_ASSERT(radius >= Length{});
  const RawVec turn_a = raws_of(a.rotation), turn_b = raws_of(b.rotation);
  RawVec translation = raws_of(a.translation) - raws_of(b.translation);
  Metres bend = 0;
  if (turn_b != RawVec{}) {
    if (!is_small(turn_b)) return Position::max();
    const Metres angle = norm_of(turn_b);  // below 1 rad
    LKS_ASSERT(angle < Metres{1} << geometry::k_metre_bits);
    bend = times(norm_of(translation), angle / 4) * 2 + k_way_rounding;
    translation = translation - cross(turn_b, raws_of(a.start.position - b.start.position));
  }
  const Metres turned =
      raw::multiply_shift(norm_of(turn_a - turn_b), radius.raw, Length::frac_bits);
  return Position::from_raw(norm_of(translation) + bend + turned + k_way_rounding);
}

}  // namespace lockstone
