#include "core/geometry/numeric/segment.h"

#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/int128.h"

namespace lockstone::geometry {
namespace {

/// numerator · 2^60 / denominator, rounded and clamped to ±limit. denominator > 0.
std::int64_t clamped_ratio(Int128 numerator, Int128 denominator, std::int64_t limit) {
  constexpr int scale = 60;
  // Bring the denominator to 63 bits and shift the numerator with it.
  const int excess = 65 - countl_zero(denominator.bits());
  const auto divisor = (excess >= 0 ? denominator >> excess : denominator << -excess).low;
  const int shift = scale - excess;
  UInt128 size = magnitude(numerator);
  const bool overflows = shift > 0 && countl_zero(size) <= shift;
  size = shift > 0 ? size << shift : size >> -shift;
  std::int64_t result = limit;
  if (!overflows && size.high < divisor) {
    const std::uint64_t quotient = round_divide(size, divisor);
    if (quotient < static_cast<std::uint64_t>(limit)) result = static_cast<std::int64_t>(quotient);
  }
  return numerator.negative() ? -result : result;
}

RawVec to_length_bits(const RawVec& v) {
  return {raw::round_shift(v.x, k_fine_per_length), raw::round_shift(v.y, k_fine_per_length),
          raw::round_shift(v.z, k_fine_per_length)};
}

/// d · n, with d in 20 fraction bits: exact in fine lanes.
Fine dot_exact(const RawVec& d, const Vec3<Unit>& n) {
  return d.x * n.x.raw + d.y * n.y.raw + d.z * n.z.raw;
}

/// d × n, likewise.
RawVec cross_exact(const RawVec& d, const Vec3<Unit>& n) {
  return {d.y * n.z.raw - d.z * n.y.raw, d.z * n.x.raw - d.x * n.z.raw,
          d.x * n.y.raw - d.y * n.x.raw};
}

/// One step of Newton's from a parameter near that of the closest point: an axis of 30 bits is not
/// of norm 1, and leaves s · 2^-30 of the way along it to the point.
Fine improved(const Segment& segment, Fine s, const RawVec& point) {
  const Fine rest = dot(point - point_at(segment, s), segment.axis);
  return clamp_to(raw::add(s, rest), fine(segment.half));
}

}  // namespace

std::int64_t clamped_ratio(std::int64_t numerator, int shift, std::int64_t denominator,
                           std::int64_t limit) {
  LKS_ASSERT(denominator > 0 && limit >= 0);
  const auto divisor = static_cast<std::uint64_t>(denominator);
  const UInt128 size = UInt128{0, magnitude(numerator)} << shift;
  std::int64_t result = limit;
  if (size.high < divisor) {
    const std::uint64_t quotient = round_divide(size, divisor);
    if (quotient < static_cast<std::uint64_t>(limit)) result = static_cast<std::int64_t>(quotient);
  }
  return numerator < 0 ? -result : result;
}

Segment core_segment(const Shape& capsule, const Mat3& rotation, const Vec3<Length>& centre) {
  return {fine(centre), rotation.y, capsule.size.y};
}

RawVec point_at(const Segment& segment, Fine s) {
  return segment.centre + along(segment.axis, s);
}

Fine closest_parameter(const Segment& segment, const RawVec& point) {
  const Fine half = fine(segment.half);
  const Fine s = clamp_to(dot(point - segment.centre, segment.axis), half);
  return improved(segment, s, point);
}

RawVec cross_of(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  return raws_of(cross(a, b));
}

ClosestParameters closest_parameters(const Segment& a, const Segment& b) {
  const RawVec d = to_length_bits(b.centre - a.centre);
  const Fine d_a = dot_exact(d, a.axis);
  const Fine d_b = dot_exact(d, b.axis);
  const Fine half_a = fine(a.half);
  const Fine half_b = fine(b.half);
  const auto cosine =
      static_cast<std::int32_t>(raw::round_shift(lockstone::dot(a.axis, b.axis).raw, 30));
  const RawVec k = cross_of(a.axis, b.axis);
  const bool parallel = k == RawVec{};

  // |d + t·b − s·a| is least at s = ((d × b) · k) / k², t = s·(a · b) − d · b.
  Fine s = parallel ? clamp_to(d_a, half_a)
                    : clamped_ratio(wide_dot(cross_exact(d, b.axis), k), wide_dot(k, k), half_a);
  bool crossing = !parallel && magnitude_of(s) < half_a;
  Fine t = raw::subtract(scaled(s, cosine), d_b);
  if (magnitude_of(t) >= half_b) {
    crossing = false;
    t = clamp_to(t, half_b);
    s = clamp_to(raw::add(d_a, scaled(t, cosine)), half_a);
    s = improved(a, s, point_at(b, t));
  } else if (!crossing) {
    t = improved(b, t, point_at(a, s));
  }
  return {s, t, crossing};
}

}  // namespace lockstone::geometry
