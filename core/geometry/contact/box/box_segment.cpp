#include "core/geometry/contact/box/box_segment.h"

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// Parameters at which the squared distance changes its quadratic, and both ends; ascending.
struct Breakpoints {
  std::array<Fine, 8> at{};
  int count = 0;

  void add(Fine s) { at[static_cast<std::size_t>(count++)] = s; }
  [[nodiscard]] Fine operator[](int i) const { return at[static_cast<std::size_t>(i)]; }
};

/// Where the segment's coordinate on `axis` reaches `bound`, clamped to the ends.
Fine crossing_parameter(const LocalSegment& segment, int axis, Fine bound) {
  const std::int64_t slope = segment.axis[axis].raw;
  const Fine rise = raw::subtract(bound, segment.centre[axis]);
  return clamped_ratio(slope < 0 ? -rise : rise, Unit::frac_bits, magnitude_of(slope),
                       segment.half);
}

Breakpoints breakpoints_of(const LocalSegment& segment) {
  LKS_ASSERT(segment.half >= 0 && is_unit(segment.axis));
  Breakpoints result;
  result.add(-segment.half);
  result.add(segment.half);
  for (int axis = 0; axis < 3; ++axis) {
    if (segment.axis[axis].raw == 0) continue;
    result.add(crossing_parameter(segment, axis, -segment.box_half[axis]));
    result.add(crossing_parameter(segment, axis, segment.box_half[axis]));
  }
  LKS_ASSERT(result.count <= static_cast<int>(result.at.size()));
  std::sort(result.at.begin(), result.at.begin() + result.count);
  return result;
}

/// Half the derivative of the squared distance along the segment.
Fine slope_at(const LocalSegment& segment, Fine s) {
  return dot(excess_of(point_at(segment, s), segment.box_half), segment.axis);
}

/// The zero of the line through (low, at_low < 0) and (high, at_high > 0).
Fine zero_between(Fine low, Fine at_low, Fine high, Fine at_high) {
  const Fine rise = at_high / 2 - at_low / 2;  // halved: the sum may need 64 bits
  if (rise == 0) return low + (high - low) / 2;
  const Fine width = high - low;
  const std::int64_t share =
      clamped_ratio(-at_low / 2, Unit::frac_bits, rise, std::int64_t{1} << Unit::frac_bits);
  return low + scaled(width, static_cast<std::int32_t>(share));
}

/// |a| of an axis with one zero component and the others in 30 bits; 30 bits.
std::int64_t length_of(const Vec3<Unit>& a) {
  return static_cast<std::int64_t>(isqrt_rounded(norm_squared(a)));
}

/// The box axis `k` crossed with the segment, not normalised.
Vec3<Unit> cross_axis(const LocalSegment& segment, int k) {
  Vec3<Unit> result;
  result[(k + 1) % 3] = -segment.axis[(k + 2) % 3];
  result[(k + 2) % 3] = segment.axis[(k + 1) % 3];
  return result;
}

OverlapAxis overlap_on_face(const LocalSegment& segment, int axis) {
  const Fine centre = segment.centre[axis];
  OverlapAxis result;
  result.axis = axis;
  result.normal[axis] = Unit::from_integer(sign_of(centre));
  result.separation = magnitude_of(centre) - segment.box_half[axis] -
                      magnitude_of(scaled(segment.half, segment.axis[axis].raw));
  return result;
}

/// The segment is a point on this axis. Precondition: `cross` is not zero.
OverlapAxis overlap_on_cross(const LocalSegment& segment, int k, const Vec3<Unit>& cross) {
  LKS_ASSERT(k >= 0 && k < 3 && cross != Vec3<Unit>{});
  const Fine centre = dot(segment.centre, cross);
  Fine reach = 0;
  for (int axis = 0; axis < 3; ++axis) {
    reach += scaled(segment.box_half[axis], abs(cross[axis]).raw);
  }
  const Fine overlap = magnitude_of(centre) - reach;
  OverlapAxis result;
  result.is_edge = true;
  result.axis = k;
  result.normal = signed_axis(direction_of(cross), sign_of(centre));
  result.separation = clamped_ratio(overlap, Unit::frac_bits, length_of(cross), Fine{1} << 61);
  LKS_ASSERT(is_unit(result.normal));
  return result;
}

}  // namespace

RawVec point_at(const LocalSegment& segment, Fine s) {
  return segment.centre + along(segment.axis, s);
}

RawVec excess_of(const RawVec& point, const RawVec& box_half) {
  return {point.x - clamp_to(point.x, box_half.x), point.y - clamp_to(point.y, box_half.y),
          point.z - clamp_to(point.z, box_half.z)};
}

Fine nearest_to_box(const LocalSegment& segment) {
  const Breakpoints points = breakpoints_of(segment);
  LKS_ASSERT(points.count >= 2);
  // The slope rises along the segment: find where it is last negative and first positive.
  int before = -1;
  Fine slope_before = 0;
  for (int i = 0; i < points.count; ++i) {
    const Fine slope = slope_at(segment, points[i]);
    if (slope < 0) {
      before = i;
      slope_before = slope;
      continue;
    }
    if (slope == 0) continue;
    if (i == 0) return points[0];
    if (before == i - 1) return zero_between(points[before], slope_before, points[i], slope);
    return (points[before + 1] + points[i - 1]) / 2;
  }
  if (before == points.count - 1) return points[before];
  return (points[before + 1] + points[points.count - 1]) / 2;
}

Interval beside_face(const LocalSegment& segment, int face_axis) {
  LKS_ASSERT(face_axis >= 0 && face_axis < 3);
  Interval result{-segment.half, segment.half};
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == face_axis) continue;
    const Fine half = segment.box_half[axis];
    if (segment.axis[axis].raw == 0) {
      if (magnitude_of(segment.centre[axis]) > half) return {1, 0};
      continue;
    }
    const Fine first = crossing_parameter(segment, axis, -half);
    const Fine second = crossing_parameter(segment, axis, half);
    result.low = std::max(result.low, std::min(first, second));
    result.high = std::min(result.high, std::max(first, second));
  }
  return result;
}

OverlapAxis least_overlap(const LocalSegment& segment) {
  OverlapAxis best = overlap_on_face(segment, 0);
  for (int axis = 1; axis < 3; ++axis) {
    const OverlapAxis candidate = overlap_on_face(segment, axis);
    if (candidate.separation > best.separation) best = candidate;
  }
  Fine threshold = edge_threshold(best.separation);
  for (int k = 0; k < 3; ++k) {
    const Vec3<Unit> cross = cross_axis(segment, k);
    if (cross == Vec3<Unit>{}) continue;
    const OverlapAxis candidate = overlap_on_cross(segment, k, cross);
    if (candidate.separation <= threshold) continue;
    best = candidate;
    threshold = candidate.separation;
  }
  LKS_ASSERT(is_unit(best.normal));
  return best;
}

}  // namespace lockstone::geometry
