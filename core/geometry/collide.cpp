#include <tuple>

#include "core/geometry/collide_pairs.h"
#include "core/geometry/contact_point.h"

namespace lockstone {
namespace {

/// The sign of the component of `offset` with the greatest magnitude, the first of equals.
int dominant_sign(const Vec3<Length>& offset) {
  int dominant = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (abs(offset[axis]) > abs(offset[dominant])) dominant = axis;
  }
  return geometry::sign_of(offset[dominant].raw);
}

auto size_key(const Shape& shape) {
  return std::tuple(shape.size.x, shape.size.y, shape.size.z);
}

/// Whether B takes the first place: the higher kind, then the greater sizes, then the lower place
/// along the axis that separates the centres most. So either order of the arguments runs the same
/// computation, and what rests on another keeps its role while it wobbles. Spheres stay as they
/// are: they have no roles.
bool belongs_first(const Shape& b, const Shape& a, const Vec3<Length>& offset) {
  if (a.kind != b.kind) return b.kind > a.kind;
  if (a.kind == ShapeKind::sphere) return false;
  const auto key_a = size_key(a);
  const auto key_b = size_key(b);
  if (key_a != key_b) return key_b > key_a;
  return dominant_sign(offset) < 0;
}

Manifold collide_ordered(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                         Length margin) {
  using namespace geometry;
  if (a.shape.kind == ShapeKind::box) {
    if (b.shape.kind == ShapeKind::sphere) return collide_box_sphere(a, b, offset, margin);
    if (b.shape.kind == ShapeKind::capsule) return collide_box_capsule(a, b, offset, margin);
    return collide_boxes(a, b, offset, margin);
  }
  if (a.shape.kind == ShapeKind::sphere) return collide_spheres(a, b, offset, margin);
  if (b.shape.kind == ShapeKind::sphere) return collide_capsule_sphere(a, b, offset, margin);
  return collide_capsules(a, b, offset, margin);
}

}  // namespace

Manifold collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                 Length margin) {
  LKS_ASSERT(margin >= Length{} && margin <= Length::from_integer(64));
  if (!belongs_first(b.shape, a.shape, offset)) return collide_ordered(a, b, offset, margin);
  return geometry::flipped(collide_ordered(b, a, -offset, margin));
}

bool overlaps(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset) {
  // A margin of zero keeps exactly the points that touch or overlap.
  return collide(a, b, offset, {}).count > 0;
}

}  // namespace lockstone
