#include "core/dynamics/joint/joint_path.h"

#include <lockstone/assert.h>
#include <lockstone/transform.h>

#include "core/geometry/convex/asset_geometry.h"

namespace lockstone {

const geometry::Curve* find_curve(AssetId path, const AssetSet* assets) {
  const Asset* asset = assets == nullptr ? nullptr : assets->find(path);
  return asset == nullptr ? nullptr : asset->geometry().curve();
}

PathFrame path_frame(const geometry::Curve& curve, const Mat3& frame_a, const Vec3<Position>& gap,
                     Position parameter) {
  const Vec3<Position> local = rotate_inverse(frame_a, gap);
  const geometry::CurvePlace place = curve.nearest(local, parameter);
  LKS_ASSERT(place.parameter >= Position{});
  const auto raw = [](std::int64_t x) { return Position::from_raw(x); };
  const auto& [x, y, z] = place.turning;
  const Vec3<Position> turning = rotate(frame_a, {raw(x), raw(y), raw(z)});
  return {multiply(frame_a, place.frame),
          rotate(frame_a, local - place.point),
          place.distance,
          {turning.x.raw, turning.y.raw, turning.z.raw}};
}

}  // namespace lockstone
