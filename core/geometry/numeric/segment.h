// Segments and the closest points of two of them, in integers.
#pragma once

#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// The points centre + s·axis, |s| ≤ half.
struct Segment {
  RawVec centre;  ///< fine
  Vec3<Unit> axis;
  Length half;
};

/// A capsule's core about `centre`.
[[nodiscard]] Segment core_segment(const Shape& capsule, const Mat3& rotation,
                                   const Vec3<Length>& centre);

[[nodiscard]] RawVec point_at(const Segment& segment, Fine s);

/// The parameter of the point of `segment` closest to `point`. Error < 2^-46 m, whatever the
/// axis' norm.
[[nodiscard]] Fine closest_parameter(const Segment& segment, const RawVec& point);

struct ClosestParameters {
  Fine on_a = 0;
  Fine on_b = 0;
  bool crossing = false;  ///< both lie inside: the connection is square to both segments
};

/// The cross product of two axes: 60 fraction bits, exact.
[[nodiscard]] RawVec cross_of(const Vec3<Unit>& a, const Vec3<Unit>& b);

/// Parameters of a closest pair. Parallel segments give one of their many pairs.
/// Centres may be up to 5500 m apart; the difference enters with 20 fraction bits.
/// Ericson, Real-Time Collision Detection, 5.1.9, with the unclamped parameter taken from cross
/// products, which keep their digits when the segments are nearly parallel.
[[nodiscard]] ClosestParameters closest_parameters(const Segment& a, const Segment& b);

/// numerator · 2^shift / denominator, rounded and clamped to ±limit. denominator > 0,
/// 0 ≤ shift ≤ 64.
[[nodiscard]] std::int64_t clamped_ratio(std::int64_t numerator, int shift,
                                         std::int64_t denominator, std::int64_t limit);

}  // namespace lockstone::geometry
