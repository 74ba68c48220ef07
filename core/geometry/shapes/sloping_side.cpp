#include "core/geometry/shapes/sloping_side.h"

#include <algorithm>
#include <bit>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

// With p = at_level + up · (level − y) and q = out · (x, z), the solid is |q| ≤ p; rays keep q.x, p
// and q.z in the lanes of a vector.

/// Brings the lanes within 2^30 and returns the shift.
int cut_lanes(RawVec& v) {
  const std::int64_t most =
      std::max({magnitude_of(v.x), magnitude_of(v.y), magnitude_of(v.z), std::int64_t{1}});
  const int shift =
      std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most))) - 30);
  v = shifted(v, shift);
  return shift;
}

/// q · q − p · p.
std::int64_t cone_form(const RawVec& v, const RawVec& w) {
  return v.x * w.x + v.z * w.z - v.y * w.y;
}

/// numerator · 2^shift / denominator with 60 fraction bits; a miss outside [0, 1].
RimHit cone_fraction(std::int64_t numerator, std::int64_t denominator, int shift) {
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  if (numerator < 0 || denominator == 0) return {};
  const UInt128 whole = UInt128{0, static_cast<std::uint64_t>(denominator)} << 60;
  UInt128 part = UInt128{0, static_cast<std::uint64_t>(numerator)} << 60;
  if (shift > countl_zero(part)) return {};
  part = shift >= 0 ? part << shift : part >> -shift;
  if (part > whole) return {};
  return {true,
          static_cast<std::int64_t>(round_divide(part, static_cast<std::uint64_t>(denominator))),
          {}};
}

}  // namespace

/// a f² + 2 b f + c = 0 has the roots k / a and c / k, k = −b ∓ √(b² − ac), without cancellation.
RimHit meet_side(const SlopingSide& side, const AxisRay& ray, const HeightRange& range) {
  const auto turned = [&side](Fine x, Fine z, Fine p) {
    return RawVec{scaled(x, side.out.raw), p, scaled(z, side.out.raw)};
  };
  RawVec o = turned(ray.start.x, ray.start.z,
                    side.at_level + scaled(side.level - ray.start.y, side.up.raw));
  RawVec w = turned(ray.way.x, ray.way.z, scaled(-ray.way.y, side.up.raw));
  const int shift = cut_lanes(o) - cut_lanes(w);
  const std::int64_t a = cone_form(w, w), b = cone_form(o, w), c = cone_form(o, o);
  const Int128 discriminant = multiply_wide(b, b) - multiply_wide(a, c);
  if (discriminant.negative()) return {};
  const auto root = static_cast<std::int64_t>(isqrt128(discriminant.bits()));
  const std::int64_t k = b > 0 ? -b - root : -b + root;
  RimHit best;
  for (RimHit hit : {cone_fraction(k, a, shift), cone_fraction(c, k, shift)}) {
    if (!hit.hit) continue;
    constexpr Fine k_seam = Fine{1} << (k_fine_bits - 30);
    const RawVec at = ray_point(ray, hit.fraction);
    const bool enters = at.y <= range.high && at.y >= range.low - k_seam;
    const Vec3<Unit> flat = direction_of(at.x, 0, at.z);
    hit.outward = {scaled(flat.x.raw, side.out.raw), side.up.raw, scaled(flat.z.raw, side.out.raw)};
    if (enters) take_earlier(best, hit);
  }
  return best;
}

}  // namespace lockstone::geometry
