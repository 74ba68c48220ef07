// Polytope against sphere: the nearest point of the polytope, or the face of least depth. Beside
// the faces of an uneven polytope GJK finds it.
#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/nearest_manifold.h"
#include "core/geometry/contact/polytope/polytope_collide.h"
#include "core/geometry/contact/polytope/polytope_point.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// A flat polytope lets a centre in its plane leave by the face that sees it, the first of equals.
int face_of(const Polytope& polytope, const NearestPoint& at, const SplitVec& centre) {
  LKS_ASSERT(!polytope.faces.empty() && at.face < static_cast<int>(polytope.faces.size()));
  if (at.face >= 0) return at.face;
  int best = 0;
  Fine highest = height_above(polytope.faces[0], centre);
  for (std::size_t i = 1; i < polytope.faces.size(); ++i) {
    const Fine height = height_above(polytope.faces[i], centre);
    if (height <= highest) continue;
    best = static_cast<int>(i);
    highest = height;
  }
  return best;
}

}  // namespace

Manifold collide_polytope_sphere(const PosedShape& polytope, const PosedShape& sphere,
                                 const Vec3<Length>& offset, Length margin) {
  LKS_ASSERT(polytope.polytope != nullptr && sphere.shape.kind == ShapeKind::sphere);
  const Polytope& p = *polytope.polytope;
  const Length radius = sphere.shape.size.x;
  const RawVec centre = to_local(polytope.rotation, offset);
  const SplitVec position = split(centre);
  if (p.one_sided && height_above(p.faces[0], position) < 0) return {};
  const NearestPoint at = nearest_point(p, centre, fine(radius) + fine(margin));
  if (at.face < 0 && is_uneven(p)) return nearest_manifold(polytope, sphere, offset, margin);
  Manifold manifold;
  if (!at.found) return manifold;
  const RawVec on_polytope = rotate(polytope.rotation, at.point);
  Fine distance = at.distance;
  if (at.face >= 0 || is_negligible(at.gap)) {
    const int face = face_of(p, at, position);
    manifold.normal = unit_axis(
        lockstone::rotate(polytope.rotation, p.faces[static_cast<std::size_t>(face)].normal));
  } else {
    const RawVec gap = rotate(polytope.rotation, at.gap);
    const Direction d = direction(gap.x, gap.y, gap.z);
    manifold.normal = d.unit;
    distance = static_cast<Fine>(d.length);
  }
  LKS_ASSERT(is_unit(manifold.normal));
  const RawVec on_sphere = fine(offset) - along(manifold.normal, radius);
  add_round_point(manifold, {on_polytope, on_sphere}, offset, distance - fine(radius), margin, 0);
  return manifold.count > 0 ? manifold : Manifold{};
}

}  // namespace lockstone::geometry
