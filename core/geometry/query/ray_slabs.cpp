#include "core/geometry/query/ray_slabs.h"

#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/q50.h"
#include "core/geometry/numeric/ray_ratio.h"

namespace lockstone::geometry {
namespace {

bool is_inside(const RawVec& point, const RawVec& half) {
  return magnitude_of(point.x) <= half.x && magnitude_of(point.y) <= half.y &&
         magnitude_of(point.z) <= half.z;
}

/// The part of the ray between all slabs looked at so far.
struct SlabPassage {
  RayRatio enter{-1, 1};
  RayRatio leave{1, 1};
  int axis = -1;  ///< of the face it enters by
  bool open = true;
};

void narrow(SlabPassage& passage, int axis, std::int64_t start, std::int64_t way, Fine half) {
  if (way == 0) {
    passage.open = passage.open && magnitude_of(start) <= half;
    return;
  }
  const std::int64_t ahead = way < 0 ? -start : start;
  const RayRatio enter{-half - ahead, magnitude_of(way)};
  const RayRatio leave{half - ahead, magnitude_of(way)};
  if (passage.axis < 0 || passage.enter < enter) {
    passage.enter = enter;
    passage.axis = axis;
  }
  if (leave < passage.leave) passage.leave = leave;
}

}  // namespace

ShapeRayHit cast_ray_at_box(const Shape& box, const Mat3& rotation, const Vec3<Length>& origin,
                            const Vec3<Length>& translation) {
  const RawVec half = half_extents(box);
  const RawVec start = to_local(rotation, origin);
  const RawVec way = to_local(rotation, translation);
  if (is_inside(start, half)) return {true, {}, {}};
  SlabPassage passage;
  for (int axis = 0; axis < 3; ++axis)
    narrow(passage, axis, start[axis], way[axis], half[axis]);
  if (!passage.open || passage.axis < 0 || passage.enter.numerator < 0) return {};
  if (passage.leave < passage.enter) return {};  // `leave` starts at 1: this covers the ray's end
  const Vec3<Unit> outward =
      signed_axis(rotation.column(passage.axis), way[passage.axis] > 0 ? -1 : 1);
  return {true, rounded(passage.enter), unit_axis(outward)};
}

}  // namespace lockstone::geometry
