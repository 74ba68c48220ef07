#include "core/geometry/dispatch/raycast.h"

#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/q50.h"
#include "core/geometry/numeric/ray_ratio.h"
#include "core/geometry/query/ray_round.h"
#include "core/geometry/query/ray_slabs.h"

namespace lockstone {
namespace {

/// Heights are exact for the rounded normal.
ShapeRayHit cast_ray_at_half_space(const Mat3& rotation, const Vec3<Length>& origin,
                                   const Vec3<Length>& translation) {
  const Vec3<Unit> normal = geometry::unit_axis(rotation.y);
  const std::int64_t height = dot(normal, origin).raw;
  if (height <= 0) return {true, {}, {}};
  const std::int64_t rise = dot(normal, translation).raw;
  if (rise > -height) return {};
  return {true, geometry::rounded(geometry::RayRatio{height, -rise}), normal};
}

}  // namespace

ShapeRayHit cast_ray(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                     const Vec3<Length>& translation) {
  using namespace geometry;
  if (const auto cast = traits_of(shape).cast_ray; cast != nullptr)
    return cast(shape, rotation, origin, translation);
  if (shape.kind == ShapeKind::sphere) return cast_ray_at_sphere(shape.size.x, origin, translation);
  return shape.kind == ShapeKind::capsule
             ? cast_ray_at_capsule(shape, rotation, origin, translation)
             : cast_ray_at_box(shape, rotation, origin, translation);
}

ShapeRayHit cast_ray(const PosedShape& posed, const Vec3<Length>& origin,
                     const Vec3<Length>& translation) {
  if (posed.shape.kind == ShapeKind::half_space)
    return cast_ray_at_half_space(posed.rotation, origin, translation);
  if (posed.polytope == nullptr) return cast_ray(posed.shape, posed.rotation, origin, translation);
  return posed.polytope->kernels->cast_ray(*posed.polytope, posed.rotation, origin, translation);
}

}  // namespace lockstone
