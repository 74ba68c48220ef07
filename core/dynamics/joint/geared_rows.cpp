#include "core/dynamics/joint/geared_rows.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/joint/joint_vectors.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

// Lengths are bounded so, m, Q32: 4096 m.
constexpr std::uint64_t k_longest = std::uint64_t{1} << 44;

std::int64_t bounded_length(std::uint64_t x) {
  return static_cast<std::int64_t>(std::min(x, k_longest));
}

// Rows of ratios beyond 1 are read per 2^shift, so that Jacobians keep their range.
int ratio_shift(const JointRecord& joint) {
  const std::int64_t ratio = joint.ratio.raw;
  const auto size = static_cast<std::uint64_t>(ratio < 0 ? -ratio : ratio);
  const int shift = std::max(0, static_cast<int>(std::bit_width(size)) - 20);
  LKS_ASSERT(size >> shift < std::uint64_t{1} << 20);
  return shift;
}

// The x axis of a body's frame, times 2^-shift.
RawVec3 scaled_axis(const Mat3& frame, int shift) {
  RawVec3 x = raw_of(frame.x);
  for (std::int64_t& part : x)
    part = shifted(part, shift);
  return x;
}

// v · ratio · 2^-shift
RawVec3 geared(const RawVec3& v, const JointRecord& joint, int shift) {
  LKS_ASSERT(20 + shift >= 1);
  RawVec3 result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = product_rounded(v[i], joint.ratio.raw, 20 + shift);
  return result;
}

// The x axes of both frames, that of A times 2^-shift.
struct GearedAxis {
  int shift;
  RawVec3 a, b;
};

GearedAxis geared_axis(const JointPlace& place) {
  const int shift = ratio_shift(place.joint);
  return {shift, scaled_axis(frame_of(place.a.rotation, place.frames.a), shift),
          raw_of(frame_of(place.b.rotation, place.frames.b).x)};
}

}  // namespace

void fill_distance(RowWriter& rows, const JointArms& arms) {
  if (!rows.is_wanted(0)) return;
  const Direction d = direction(arms.gap);
  if (d.length == 0) return;
  const auto row = [&] { return rows.linear_row(arms, raw_of(d.unit)); };
  const std::int64_t length = bounded_length(d.length);
  LKS_ASSERT(length >= 0);
  if (rows.is_rigid(0)) {
    const std::int64_t target = rows.value_of(0, rows.place().joint.axes[0].target);
    return rows.push(row, 0, RowKind::lock, length - target);
  }
  rows.add_axis(0, row, length);
}

void fill_pulley(RowWriter& rows, const JointArms& arms) {
  const JointPlace& place = rows.place();
  const Direction a = direction((place.a.position + arms.a) - place.joint.ground_a);
  const Direction b = direction((place.b.position + arms.b) - place.joint.ground_b);
  const std::int64_t ratio = std::int64_t{place.joint.ratio.raw} << 10;
  LKS_ASSERT(ratio > 0);
  RawVec3 n = raw_of(b.unit);
  for (std::int64_t& x : n)
    x = product_rounded(x, ratio, 30);
  JointRow row;
  row.linear_a = raw_of(a.unit);
  row.linear_b = n;
  row.angular_a = lever(arms.a, row.linear_a, place.scale_a);
  row.angular_b = lever(arms.b, row.linear_b, place.scale_b);
  const std::int64_t out = bounded_length(a.length) +
                           product_rounded(bounded_length(b.length), ratio, 30) -
                           (std::int64_t{place.joint.total_length.raw} << 12);
  rows.push([&] { return row; }, 0, RowKind::lock, out);
}

void fill_gear(RowWriter& rows) {
  const JointPlace& place = rows.place();
  const GearedAxis axis = geared_axis(place);
  JointRow row;
  row.angular_a = negated(rows.angular_row(axis.a).angular_a);
  row.angular_b = rows.angular_row(geared(axis.b, place.joint, axis.shift)).angular_b;
  rows.push([&] { return row; }, 0, RowKind::lock, 0);
}

void fill_rack(RowWriter& rows, const JointArms& arms) {
  const JointPlace& place = rows.place();
  const GearedAxis axis = geared_axis(place);
  JointRow row;
  row.angular_a = negated(rows.angular_row(axis.a).angular_a);
  row.linear_b = geared(axis.b, place.joint, axis.shift - place.exponent);
  row.angular_b = lever(arms.b, row.linear_b, place.scale_b);
  rows.push([&] { return row; }, 0, RowKind::lock, 0);
}

}  // namespace lockstone
