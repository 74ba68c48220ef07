#include "core/geometry/distance/motion/shape_cast.h"

#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/epa/epa.h"

namespace lockstone {
namespace geometry {
namespace {

constexpr int k_max_cast_steps = 96;

/// Of the least distance that a step leaves: so much apart, shapes are apart on the lattice too,
/// and no step ends earlier.
constexpr Fine k_most_left = 16;

/// Fractions of the translation, 60 bits.
using Fraction = std::int64_t;
constexpr int k_cast_fraction_bits = 60;
constexpr Fraction k_whole_cast = Fraction{1} << k_cast_fraction_bits;

/// The last that rounds down to the limit.
Fraction last_of(Unit limit) {
  constexpr int shift = k_cast_fraction_bits - Unit::frac_bits;
  return std::min(k_whole_cast, ((Fraction{limit.raw} + 1) << shift) - 1);
}

/// The part of a translation, fine.
Fine travelled(Length way, Fraction fraction) {
  constexpr int shift = k_cast_fraction_bits + Length::frac_bits - k_fine_bits;
  return static_cast<Fine>(round_shift(multiply_wide(std::int64_t{way.raw}, fraction), shift).low);
}

RawVec travelled(const Vec3<Length>& way, Fraction fraction) {
  return {travelled(way.x, fraction), travelled(way.y, fraction), travelled(way.z, fraction)};
}

/// How much nearer along the normal the whole translation brings B, plus the normal's rounding
/// error.
Fine approach(const Vec3<Length>& way, const Vec3<Unit>& normal) {
  return sum_of_magnitudes(way) - lockstone::dot(way, normal).raw;
}

/// distance / approach, rounded down; 1 and more give k_whole_cast.
Fraction quotient(Fine distance, Fine approach) {
  if (distance >= approach) return k_whole_cast;
  const UInt128 numerator = UInt128{0, static_cast<std::uint64_t>(distance)}
                            << k_cast_fraction_bits;
  return static_cast<Fraction>(divide(numerator, static_cast<std::uint64_t>(approach)).quotient);
}

/// The distance that each step leaves: where the lattice decides, half the resolution of a length
/// and two of its steps; else twice the error of a distance, for the resolution of the path takes
/// its part of the 2 µm.
Fine clearance(const GapQuery& query) {
  constexpr Fine half = Fine{1} << (k_fine_per_length - 1);
  return query.is_coarse() ? half / 2 : half + (Fine{2} << query.lattice().shift);
}

ShapeCastHit hit_at(Fraction fraction, const CoreGap& gap, const GapQuery& query) {
  ShapeCastHit hit;
  hit.hit = true;
  hit.fraction.raw =
      static_cast<std::int32_t>(fraction >> (k_cast_fraction_bits - Unit::frac_bits));
  hit.normal = gap.normal;
  const Witnesses surface =
      inflate(gap.on_a, query.a().radius, gap.on_b, query.b().radius, gap.normal);
  hit.point_a = to_length(surface.on_a);
  hit.point_b = to_length(surface.on_b - query.fine_pair().offset);
  return hit;
}

ShapeCastHit overlapping_hit(const CoreGap& gap, const GapQuery& query) {
  ShapeCastHit hit = hit_at(0, gap, query);
  hit.overlapping = true;
  return hit;
}

/// Where B has come.
struct Progress {
  const RawVec& start;
  const Vec3<Length>& way;
  Fraction fraction;
};

/// The distance of the surfaces, the part of it that must remain, and the part that the whole path
/// takes.
struct Closing {
  Fine apart;
  Fine leave;
  Fine nearer;
};

/// The step to take, with the query done there; 0 when there is none. Flush faces may overlap on
/// the lattice where less is left than it rounds by: then twice as much is left, and again.
Fraction step_to_apart(GapQuery& query, const Progress& at, const Closing& closing) {
  for (Fine leave = closing.leave; leave < closing.apart; leave *= 2) {
    const Fraction step = quotient(closing.apart - leave, closing.nearer);
    if (query.find(at.start + travelled(at.way, at.fraction + step))) return step;
  }
  return 0;
}

ShapeCastHit ordered_cast(const PosedShape& a, const PosedShape& b, const RawVec& start,
                          const Vec3<Length>& way, Fraction limit) {
  GapQuery query(a, b);
  if (!query.find(start)) return overlapping_hit(core_overlap(query).gap, query);
  if (query.gap().distance <= query.radii()) return overlapping_hit(query.gap(), query);
  Fraction fraction = 0;
  // A plane separates the shapes up to `fraction`.
  for (int step = 0; step < k_max_cast_steps; ++step) {
    const Fine apart = query.gap().distance - query.radii();
    const Fine leave = clearance(query);
    const Fine nearer = approach(way, query.gap().normal);
    if (nearer <= 0) return {};
    const Fraction advance = quotient(std::max(Fine{0}, apart - leave), nearer);
    if (advance > k_whole_cast - fraction) return {};
    if (apart <= 2 * leave) break;
    const Fraction least = quotient(std::max(Fine{0}, apart - k_most_left * leave), nearer);
    if (least > limit - fraction) return {};
    const ShapeCastHit here = hit_at(fraction, query.gap(), query);
    const Fraction taken = step_to_apart(query, {start, way, fraction}, {apart, leave, nearer});
    if (taken == 0) return here;
    fraction += taken;
  }
  return hit_at(fraction, query.gap(), query);
}

}  // namespace
}  // namespace geometry

ShapeCastHit cast_shape(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                        const Vec3<Length>& translation, Unit limit) {
  using namespace geometry;
  const Fraction last = last_of(limit);
  const RawVec start = fine(offset);
  if (!is_exchanged(a, b, start)) return ordered_cast(a, b, start, translation, last);
  ShapeCastHit hit = ordered_cast(b, a, -start, -translation, last);
  hit.normal = -hit.normal;
  std::swap(hit.point_a, hit.point_b);
  return hit;
}

}  // namespace lockstone
