#include "core/geometry/submerged/clipped_solid.h"

#include <lockstone/assert.h>

namespace lockstone::geometry {
namespace {

std::int64_t part_of(Int128 sum, int divisor, int shift) {
  const std::int64_t whole = saturate_to_int64(round_shift(sum, shift));
  return raw::round_divide(whole, divisor);
}

ScaledPoint point_of_plane(const Vec3<Unit>& normal, std::int64_t offset) {
  ScaledPoint point{};
  for (int i = 0; i < 3; ++i)
    point[static_cast<std::size_t>(i)] =
        raw::round_shift(normal[i].raw * (offset >> 1), 2 * 30 - k_scaled_bits - 1);
  return point;
}

}  // namespace

ClippedSolid::ClippedSolid(const Vec3<Unit>& normal, std::int64_t offset)
    : normal_(normal), offset_(offset), apex_(point_of_plane(normal, offset)) {
  LKS_ASSERT(offset >= -(std::int64_t{1} << 31) && offset <= std::int64_t{1} << 31);
}

// Above the plane; 58 fraction bits.
std::int64_t ClippedSolid::height_of(const ScaledPoint& point) const {
  return normal_.x.raw * point[0] + normal_.y.raw * point[1] + normal_.z.raw * point[2] -
         offset_ * (std::int64_t{1} << k_scaled_bits);
}

void ClippedSolid::add_face(std::span<const ScaledPoint> vertices) {
  corners_ = 0;
  ScaledPoint out{}, in{};  // where the face leaves the part below the plane, and comes back
  std::size_t before = vertices.size() - 1;
  std::int64_t height_before = height_of(vertices[before]);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::int64_t height = height_of(vertices[i]);
    if ((height_before <= 0) != (height <= 0)) {
      // From the vertex below, so that both faces of an edge find the same point.
      const bool rises = height > 0;
      const ScaledPoint& low = vertices[rises ? before : i];
      const ScaledPoint& high = vertices[rises ? i : before];
      const std::int64_t below = rises ? height_before : height;
      const std::int64_t span = (rises ? height : height_before) - below;
      ScaledPoint cut;
      for (std::size_t axis = 0; axis < 3; ++axis)
        cut[axis] = low[axis] + round_divide(multiply_wide(high[axis] - low[axis], -below), span);
      add_corner(cut);
      (rises ? out : in) = cut;
    }
    if (height <= 0) add_corner(vertices[i]);
    before = i;
    height_before = height;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] -= apex_[axis];
    in[axis] -= apex_[axis];
  }
  if (corners_ == 0) return;
  const ScaledPoint area = cross(out, in);
  for (std::size_t axis = 0; axis < 3; ++axis)
    section_[axis] += area[axis];
}

void ClippedSolid::add_corner(const ScaledPoint& corner) {
  ScaledPoint point;
  for (std::size_t axis = 0; axis < 3; ++axis)
    point[axis] = corner[axis] - apex_[axis];
  if (corners_++ == 0) first_ = point;
  if (corners_ >= 3) {
    const ScaledPoint normal = cross(last_, point);
    Int128 volume{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      volume = volume + multiply_wide(first_[axis], normal[axis]);
    volume_ = volume_ + volume;
    const std::int64_t weight =
        saturate_to_int64(round_shift(volume, 3 * k_scaled_bits - k_submerged_bits));
    for (std::size_t axis = 0; axis < 3; ++axis)
      moment_[axis] =
          moment_[axis] + multiply_wide(weight, first_[axis] + last_[axis] + point[axis]);
  }
  last_ = point;
}

void ClippedSolid::finish(SubmergedPart& part) const {
  part.volume = part_of(volume_, 6, 3 * k_scaled_bits - k_submerged_bits);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Int128 shifted = multiply_wide(part.volume, apex_[axis]);
    part.moment[axis] = part_of(moment_[axis], 24, k_scaled_bits) +
                        saturate_to_int64(round_shift(shifted, k_scaled_bits));
  }
  Int128 area{};
  for (int axis = 0; axis < 3; ++axis)
    area = area +
           multiply_wide(section_[static_cast<std::size_t>(axis)], std::int64_t{normal_[axis].raw});
  const std::int64_t twice =
      saturate_to_int64(round_shift(area, 2 * k_scaled_bits + 30 - k_submerged_bits));
  part.plane_area = (twice < 0 ? -twice : twice) / 2;
}

}  // namespace lockstone::geometry
