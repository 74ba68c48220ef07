#include "core/geometry/dispatch/collide.h"

#include <tuple>

#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/distance/contact_point.h"

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

/// The order of kinds: spheres, capsules, boxes, other primitives, hulls, half-spaces.
int place_of(ShapeKind kind) {
  constexpr int k_after_all = static_cast<int>(k_last_shape_kind) + 1;
  if (kind == ShapeKind::hull) return k_after_all;
  return kind == ShapeKind::half_space ? k_after_all + 1 : static_cast<int>(kind);
}

/// Of one kind, the greater comes first: one-sided ones, then by asset, then by sizes.
auto rank(const PosedShape& posed) {
  const bool one_sided = posed.polytope != nullptr && posed.polytope->one_sided;
  const Shape& shape = posed.shape;
  return std::tuple(one_sided, shape.asset.value, shape.size.x, shape.size.y, shape.size.z);
}

auto entries_of(const Mat3& m) {
  return std::tuple(m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z);
}

/// Whether B takes the first place: the higher kind, then the higher rank, then the lower place
/// along the axis that separates the centres most; concentric ones go by their rotations. So either
/// order of the arguments runs the same computation, and a shape that rests on another keeps its
/// role while it wobbles. Spheres stay as they are: they have no roles.
bool belongs_first(const PosedShape& b, const PosedShape& a, const Vec3<Length>& offset) {
  if (a.shape.kind != b.shape.kind) return place_of(b.shape.kind) > place_of(a.shape.kind);
  if (a.shape.kind == ShapeKind::sphere) return false;
  const auto rank_a = rank(a);
  const auto rank_b = rank(b);
  if (rank_a != rank_b) return rank_b > rank_a;
  if (offset == Vec3<Length>{}) return entries_of(b.rotation) > entries_of(a.rotation);
  return dominant_sign(offset) < 0;
}

Manifold collide_primitives(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                            Length margin) {
  using namespace geometry;
  if (a.shape.kind == ShapeKind::box) {
    if (b.shape.kind == ShapeKind::sphere) return collide_box_sphere(a, b, offset, margin);
    return collide_box_capsule(a, b, offset, margin);
  }
  if (a.shape.kind == ShapeKind::sphere) return collide_spheres(a, b, offset, margin);
  if (b.shape.kind == ShapeKind::sphere) return collide_capsule_sphere(a, b, offset, margin);
  return collide_capsules(a, b, offset, margin);
}

Manifold collide_ordered(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                         Length margin, const HeldFeatures& held) {
  if (a.shape.kind <= ShapeKind::box) return collide_primitives(a, b, offset, margin);
  if (a.shape.kind == ShapeKind::half_space) {
    const bool rounded = b.polytope != nullptr && b.polytope->radius > Length{};
    return rounded ? b.polytope->kernels->collide(a, b, offset, margin, held)
                   : geometry::collide_half_space(a, b, offset, margin);
  }
  if (a.polytope == nullptr) return geometry::traits_of(a.shape).collide(a, b, offset, margin);
  return a.polytope->kernels->collide(a, b, offset, margin, held);
}

void collide_two_boxes(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                       Length margin, const HeldFeatures& held, Manifold& out) {
  if (!geometry::box_belongs_first(b, a, offset))
    return geometry::collide_boxes(a, b, offset, margin, false, held, out);
  const Vec3<Length> back = -offset;
  geometry::collide_boxes(b, a, back, margin, true, held, out);
}

}  // namespace

void collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset, Length margin,
             const HeldFeatures& held, Manifold& out) {
  LKS_ASSERT(margin >= Length{} && margin <= Length::from_integer(64));
  if (a.shape.kind == ShapeKind::box && b.shape.kind == ShapeKind::box)
    return collide_two_boxes(a, b, offset, margin, held, out);
  out = belongs_first(b, a, offset)
            ? geometry::flipped(collide_ordered(b, a, -offset, margin, held))
            : collide_ordered(a, b, offset, margin, held);
}

void collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset, Length margin,
             Manifold& out) {
  collide(a, b, offset, margin, {}, out);
}

Manifold collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                 Length margin) {
  Manifold manifold;
  collide(a, b, offset, margin, manifold);
  return manifold;
}

bool overlaps(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset) {
  // A margin of zero keeps exactly the points that touch or overlap.
  return collide(a, b, offset, {}).count > 0;
}

namespace geometry {

// As `belongs_first`: their sizes are all their rank.
bool box_belongs_first(const PosedShape& b, const PosedShape& a, const Vec3<Length>& offset) {
  const Vec3<Length>& size_a = a.shape.size;
  const Vec3<Length>& size_b = b.shape.size;
  if (size_a.x != size_b.x) return size_b.x > size_a.x;
  if (size_a.y != size_b.y) return size_b.y > size_a.y;
  if (size_a.z != size_b.z) return size_b.z > size_a.z;
  if (offset == Vec3<Length>{}) return entries_of(b.rotation) > entries_of(a.rotation);
  return dominant_sign(offset) < 0;
}

}  // namespace geometry
}  // namespace lockstone
