// Pairs with a sphere: the closest point of the other shape's core, and the direction to it.
#include <lockstone/assert.h>

#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

struct SphereGap {
  Vec3<Unit> normal;
  Fine distance = 0;
};

/// Direction and length of a fine vector; a zero vector takes the direction `otherwise`.
SphereGap gap_of(const RawVec& v, const Vec3<Unit>& otherwise) {
  if (v == RawVec{}) return {otherwise, 0};
  const Direction d = direction(v.x, v.y, v.z);
  return {d.unit, static_cast<Fine>(d.length)};
}

Manifold round_contact(const RawVec& core_a, Length radius_a, const RawVec& core_b, Length radius_b,
                       const SphereGap& gap, const Vec3<Length>& offset, Length margin) {
  Manifold manifold;
  const Fine separation = gap.distance - fine(radius_a) - fine(radius_b);
  if (!keeps(separation, margin)) return manifold;
  manifold.normal = gap.normal;
  add_point(manifold, inflate(core_a, radius_a, core_b, radius_b, gap.normal), offset, separation,
            margin, 0);
  return manifold;
}

/// The face that a point inside the box is nearest to: axis and sign.
struct NearestFace {
  int axis = 0;
  int sign = 1;
  Fine distance = 0;  ///< negative inside
};

NearestFace nearest_face(const RawVec& point, const RawVec& half) {
  NearestFace best;
  for (int axis = 0; axis < 3; ++axis) {
    const Fine distance = magnitude_of(point[axis]) - half[axis];
    if (axis == 0 || distance > best.distance) best = {axis, sign_of(point[axis]), distance};
  }
  return best;
}

Manifold sphere_inside_box(const PosedShape& box, const RawVec& centre, Length radius,
                           const Vec3<Length>& offset, Length margin) {
  const NearestFace face = nearest_face(centre, half_extents(box.shape));
  Manifold manifold;
  manifold.normal = unit_axis(signed_axis(box.rotation.column(face.axis), face.sign));
  RawVec on_box = centre;
  on_box[face.axis] -= face.sign * face.distance;
  LKS_ASSERT(is_unit(manifold.normal) && face.axis >= 0 && face.axis < 3);
  const RawVec on_sphere = fine(offset) - along(manifold.normal, radius);
  add_round_point(manifold, {rotate(box.rotation, on_box), on_sphere}, offset,
                  face.distance - fine(radius), margin, 0);
  return manifold;
}

}  // namespace

Manifold collide_spheres(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                         Length margin) {
  const RawVec centre = fine(offset);
  const int up = a.shape.size.x < b.shape.size.x ? -1 : 1;
  return round_contact({}, a.shape.size.x, centre, b.shape.size.x,
                       gap_of(centre, signed_axis(k_concentric_normal, up)), offset, margin);
}

Manifold collide_capsule_sphere(const PosedShape& capsule, const PosedShape& sphere,
                                const Vec3<Length>& offset, Length margin) {
  LKS_ASSERT(capsule.shape.kind == ShapeKind::capsule && sphere.shape.kind == ShapeKind::sphere);
  const Segment core = core_segment(capsule.shape, capsule.rotation, {});
  const RawVec centre = fine(offset);
  const RawVec closest = point_at(core, closest_parameter(core, centre));
  const RawVec gap = centre - closest;
  return round_contact(
      closest, capsule.shape.size.x, centre, sphere.shape.size.x,
      is_negligible(gap) ? SphereGap{perpendicular_to(core.axis), 0} : gap_of(gap, core.axis),
      offset, margin);
}

Manifold collide_box_sphere(const PosedShape& box, const PosedShape& sphere,
                            const Vec3<Length>& offset, Length margin) {
  LKS_ASSERT(box.shape.kind == ShapeKind::box && sphere.shape.kind == ShapeKind::sphere);
  const RawVec half = half_extents(box.shape);
  const Length radius = sphere.shape.size.x;
  const RawVec centre = to_local(box.rotation, offset);
  const RawVec closest{clamp_to(centre.x, half.x), clamp_to(centre.y, half.y),
                       clamp_to(centre.z, half.z)};
  const RawVec gap = centre - closest;
  if (is_negligible(gap)) return sphere_inside_box(box, centre, radius, offset, margin);
  const SphereGap world_gap = gap_of(rotate(box.rotation, gap), k_concentric_normal);
  Manifold manifold;
  manifold.normal = world_gap.normal;
  LKS_ASSERT(is_unit(manifold.normal));
  add_round_point(manifold,
                  {rotate(box.rotation, closest), fine(offset) - along(world_gap.normal, radius)},
                  offset, world_gap.distance - fine(radius), margin, 0);
  return manifold.count > 0 ? manifold : Manifold{};
}

}  // namespace lockstone::geometry
