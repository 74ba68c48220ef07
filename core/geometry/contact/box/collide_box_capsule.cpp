// Box against capsule. Apart: the point of the core nearest to the box. A core inside the box: the
// axis of least overlap. Where a face meets the side, the core is clipped against the face's side
// planes and gives two points.
#include <lockstone/assert.h>

#include "core/geometry/contact/box/box_segment.h"
#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// The pair, in both frames.
struct BoxCapsule {
  const PosedShape& box;
  const Vec3<Length>& offset;
  Length radius;
  Length margin;
  Length half_height;
  Vec3<Unit> axis;     ///< of the capsule, in world axes
  LocalSegment local;  ///< the core, in the box's axes
};

/// Features: 0 a single nearest point, else the axis that decided.
constexpr std::uint32_t face_feature(int axis, int sign, int end) {
  return 0x10U | static_cast<std::uint32_t>(axis << 2 | (sign < 0 ? 2 : 0) | end);
}
constexpr std::uint32_t edge_axis_feature(int axis) {
  return 0x20U | static_cast<std::uint32_t>(axis);
}

RawVec core_point(const BoxCapsule& pair, Fine s) {
  return fine(pair.offset) + along(pair.axis, s);
}

/// Height of a core point above the face.
Fine height_at(const BoxCapsule& pair, int axis, int sign, Fine s) {
  return sign * point_at(pair.local, s)[axis] - pair.local.box_half[axis];
}

void add_face_point(Manifold& manifold, const BoxCapsule& pair, int axis, int sign, Fine s,
                    std::uint32_t feature) {
  RawVec on_face = point_at(pair.local, s);
  const Fine height = height_at(pair, axis, sign, s);
  on_face[axis] = sign * pair.local.box_half[axis];
  const RawVec on_capsule = core_point(pair, s) - along(manifold.normal, pair.radius);
  add_round_point(manifold, {rotate(pair.box.rotation, on_face), on_capsule}, pair.offset,
                  height - fine(pair.radius), pair.margin, feature);
}

/// Whether the face may meet the core's point at an end of the part beside the face. An end of the
/// core has a ball around it; elsewhere the core must lean from the face by 1/32 at most, for then
/// the normal of the face misses the capsule's surface by at most 1/2000 of the radius.
bool may_meet(const BoxCapsule& pair, int axis, Fine s) {
  return magnitude_of(s) == pair.local.half || abs(pair.local.axis[axis]).raw <= (1 << 25);
}

Fine deeper_end(const BoxCapsule& pair, int axis, int sign, const Interval& beside) {
  return sign * pair.local.axis[axis].raw > 0 ? beside.low : beside.high;
}

Manifold face_manifold(const BoxCapsule& pair, int axis, int sign, const Interval& beside) {
  LKS_ASSERT(axis >= 0 && axis < 3 && (sign == 1 || sign == -1));
  Manifold manifold;
  manifold.normal = unit_axis(signed_axis(pair.box.rotation.column(axis), sign));
  const bool low_is_deeper = sign * pair.local.axis[axis].raw > 0;
  const bool both = beside.low < beside.high;
  if (low_is_deeper || (both && may_meet(pair, axis, beside.low)))
    add_face_point(manifold, pair, axis, sign, beside.low, face_feature(axis, sign, 0));
  if (!low_is_deeper || (both && may_meet(pair, axis, beside.high)))
    add_face_point(manifold, pair, axis, sign, beside.high, face_feature(axis, sign, 1));
  if (manifold.count == 0) return {};
  LKS_ASSERT(is_manifold(manifold));
  return manifold;
}

/// The face that a gap points at within 1/64, or −1.
int facing_axis(const RawVec& gap) {
  for (int axis = 0; axis < 3; ++axis) {
    const Fine limit = magnitude_of(gap[axis]) / 64;
    const Fine u = magnitude_of(gap[(axis + 1) % 3]);
    const Fine v = magnitude_of(gap[(axis + 2) % 3]);
    if (u <= limit && v <= limit) return axis;
  }
  return -1;
}

Manifold nearest_point(const BoxCapsule& pair, Fine s, const RawVec& gap) {
  LKS_ASSERT(gap != RawVec{} && magnitude_of(s) <= pair.local.half);
  const RawVec world_gap = rotate(pair.box.rotation, gap);
  const Direction d = direction(world_gap.x, world_gap.y, world_gap.z);
  Manifold manifold;
  manifold.normal = d.unit;
  const RawVec on_box = rotate(pair.box.rotation, point_at(pair.local, s) - gap);
  const RawVec on_capsule = core_point(pair, s) - along(d.unit, pair.radius);
  add_round_point(manifold, {on_box, on_capsule}, pair.offset,
                  static_cast<Fine>(d.length) - fine(pair.radius), pair.margin, 0);
  return manifold;
}

/// Whether the part beside the face comes as near to it as the core comes to the box.
bool attains_face(const BoxCapsule& pair, int axis, int sign, const Interval& beside,
                  Fine distance) {
  const Fine nearest =
      std::min(height_at(pair, axis, sign, beside.low), height_at(pair, axis, sign, beside.high));
  return nearest <= distance + distance / 2048;
}

Manifold collide_apart(const BoxCapsule& pair, Fine s, const RawVec& gap) {
  LKS_ASSERT(!is_negligible(gap));
  const auto distance = static_cast<Fine>(norm(gap.x, gap.y, gap.z));
  if (!keeps(distance - fine(pair.radius), pair.margin)) {
    const RawVec world_gap = rotate(pair.box.rotation, gap);
    return separated_by(direction_of(world_gap.x, world_gap.y, world_gap.z));
  }
  const int axis = facing_axis(gap);
  if (axis < 0) return nearest_point(pair, s, gap);
  const Interval beside = beside_face(pair.local, axis);
  const int sign = sign_of(gap[axis]);
  if (beside.high - beside.low <= fine(pair.radius) / 16) return nearest_point(pair, s, gap);
  if (!may_meet(pair, axis, deeper_end(pair, axis, sign, beside)) ||
      !attains_face(pair, axis, sign, beside, distance))
    return nearest_point(pair, s, gap);
  const Manifold manifold = face_manifold(pair, axis, sign, beside);
  return manifold.count > 0 ? manifold : nearest_point(pair, s, gap);
}

/// The box's edge along `axis` that reaches farthest towards the normal, as a segment.
Segment support_edge(const BoxCapsule& pair, int axis, const Vec3<Unit>& local_normal) {
  RawVec centre;
  for (int k = 0; k < 3; ++k) {
    if (k == axis) continue;
    centre[k] = sign_of(local_normal[k].raw) * pair.local.box_half[k];
  }
  return {rotate(pair.box.rotation, centre), pair.box.rotation.column(axis),
          pair.box.shape.size[axis]};
}

Manifold edge_manifold(const BoxCapsule& pair, const OverlapAxis& overlap) {
  LKS_ASSERT(overlap.is_edge && is_unit(overlap.normal));
  const RawVec n = rotate(pair.box.rotation,
                          RawVec{overlap.normal.x.raw, overlap.normal.y.raw, overlap.normal.z.raw});
  const Segment edge = support_edge(pair, overlap.axis, overlap.normal);
  const Segment core{fine(pair.offset), pair.axis, pair.half_height};
  const ClosestParameters at = closest_parameters(edge, core);
  Manifold manifold;
  manifold.normal = direction_of(n.x, n.y, n.z);
  const RawVec on_capsule = point_at(core, at.on_b) - along(manifold.normal, pair.radius);
  add_round_point(manifold, {point_at(edge, at.on_a), on_capsule}, pair.offset,
                  overlap.separation - fine(pair.radius), pair.margin,
                  edge_axis_feature(overlap.axis));
  return manifold;
}

Manifold collide_inside(const BoxCapsule& pair) {
  const OverlapAxis overlap = least_overlap(pair.local);
  if (overlap.is_edge) return edge_manifold(pair, overlap);
  const int sign = sign_of(overlap.normal[overlap.axis].raw);
  const Interval beside = beside_face(pair.local, overlap.axis);
  if (beside.low <= beside.high) return face_manifold(pair, overlap.axis, sign, beside);
  const Fine s = nearest_to_box(pair.local);  // grazes an edge of the face within half a micrometre
  return face_manifold(pair, overlap.axis, sign, {s, s});
}

}  // namespace

Manifold collide_box_capsule(const PosedShape& box, const PosedShape& capsule,
                             const Vec3<Length>& offset, Length margin) {
  LKS_ASSERT(box.shape.kind == ShapeKind::box && capsule.shape.kind == ShapeKind::capsule);
  const Vec3<Unit>& axis = capsule.rotation.y;
  const BoxCapsule pair{box,
                        offset,
                        capsule.shape.size.x,
                        margin,
                        capsule.shape.size.y,
                        axis,
                        {to_local(box.rotation, offset), to_local(box.rotation, axis),
                         fine(capsule.shape.size.y), half_extents(box.shape)}};
  const Fine s = nearest_to_box(pair.local);
  const RawVec gap = excess_of(point_at(pair.local, s), pair.local.box_half);
  if (is_negligible(gap)) return collide_inside(pair);
  return collide_apart(pair, s, gap);
}

}  // namespace lockstone::geometry
