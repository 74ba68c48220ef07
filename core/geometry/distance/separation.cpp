#include "core/geometry/distance/separation.h"

#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone {
namespace {

using geometry::Fine;

constexpr Fine k_slack = Fine{1} << (geometry::k_fine_bits - 13);  // 122 µm
constexpr int k_relative_slack_bits = 26;

/// How far the shape reaches from its centre along a unit axis. Half-spaces have no reach.
Fine reach_along(const PosedShape& posed, const Vec3<Unit>& axis) {
  const Vec3<Unit> n = rotate_inverse(posed.rotation, axis);
  if (posed.polytope != nullptr)
    return geometry::support_of(*posed.polytope, n).height + geometry::fine(posed.polytope->radius);
  return geometry::traits_of(posed.shape).reach(posed.shape, n);
}

/// A contact on a merged face is nearer than the vertices by up to this: above each point of the
/// face's polygon the plane is as far from the solid at most.
Fine unevenness_of(const PosedShape& posed) {
  return posed.polytope != nullptr ? posed.polytope->unevenness : 0;
}

}  // namespace

bool separated_along(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                     Length margin, const Vec3<Unit>& axis) {
  const Fine enough = geometry::fine(margin) + k_slack + unevenness_of(a) + unevenness_of(b);
  const bool a_is_half_space = a.shape.kind == ShapeKind::half_space;
  if (a_is_half_space || b.shape.kind == ShapeKind::half_space) {
    const PosedShape& plane = a_is_half_space ? a : b;
    const Vec3<Unit> normal = geometry::unit_axis(plane.rotation.y);
    const Fine centre = a_is_half_space ? dot(normal, offset).raw : -dot(normal, offset).raw;
    return centre - reach_along(a_is_half_space ? b : a, -normal) > enough;
  }
  const Fine reach_a = reach_along(a, axis);
  const Fine reach_b = reach_along(b, -axis);
  const Fine sizes = geometry::magnitude_of(reach_a) + geometry::magnitude_of(reach_b);
  return dot(axis, offset).raw - reach_a - reach_b > enough + (sizes >> k_relative_slack_bits);
}

}  // namespace lockstone
