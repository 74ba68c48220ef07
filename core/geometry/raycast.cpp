#include "core/geometry/raycast.h"

#include "core/geometry/fine.h"
#include "core/geometry/ray_round.h"
#include "core/geometry/ray_slabs.h"

namespace lockstone {

ShapeRayHit cast_ray(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                     const Vec3<Length>& translation) {
  using namespace geometry;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return cast_ray_at_sphere(shape.size.x, origin, translation);
    case ShapeKind::capsule:
      return cast_ray_at_capsule(shape, rotation, origin, translation);
    case ShapeKind::box:
      break;
  }
  return cast_ray_at_box(shape, rotation, origin, translation);
}

}  // namespace lockstone
