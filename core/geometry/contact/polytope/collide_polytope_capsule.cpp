// Polytope against capsule. Apart: the point of the core nearest to the polytope. A core inside:
// the axis of least overlap. Where a face meets the side, the core is clipped against the face's
// side planes and gives two points. GJK and EPA decide the cases that these features do not prove.
#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/manifold/nearest_manifold.h"
#include "core/geometry/contact/polytope/polytope_collide.h"
#include "core/geometry/contact/polytope/polytope_segment.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

struct PolytopeCapsule {
  const PosedShape& polytope;
  const PosedShape& capsule;
  const Vec3<Length>& offset;
  Length radius;
  Length margin;
  Length half_height;
  Vec3<Unit> axis;  ///< of the capsule, in world axes
  PolytopeSegment local;

  [[nodiscard]] const PolytopeFace& face(int i) const {
    return local.polytope.faces[static_cast<std::size_t>(i)];
  }
};

/// Features: 0 a single nearest point, else the face and the end, or the edge.
constexpr std::uint32_t face_feature(int face, int end) {
  return 1U << 12 | static_cast<std::uint32_t>(face << 1 | end);
}
constexpr std::uint32_t edge_feature(int edge) {
  return 2U << 12 | static_cast<std::uint32_t>(edge);
}

RawVec core_point(const PolytopeCapsule& pair, Fine s) {
  return fine(pair.offset) + along(pair.axis, s);
}

Fine height_at(const PolytopeCapsule& pair, int face, Fine s) {
  return height_above(pair.face(face), split(pair.local.at(s)));
}

void add_face_point(Manifold& manifold, const PolytopeCapsule& pair, int face, Fine s,
                    std::uint32_t feature) {
  const Fine height = height_at(pair, face, s);
  const RawVec on_face = pair.local.at(s) - along(pair.face(face).normal, height);
  const RawVec on_capsule = core_point(pair, s) - along(manifold.normal, pair.radius);
  add_round_point(manifold, {rotate(pair.polytope.rotation, on_face), on_capsule}, pair.offset,
                  height - fine(pair.radius), pair.margin, feature);
}

/// 30 fraction bits.
std::int64_t slope_over(const PolytopeCapsule& pair, int face) {
  return raw::round_shift(lockstone::dot(pair.face(face).normal, pair.local.axis).raw,
                          Unit::frac_bits);
}

/// Whether the face may meet the core's point at an end of the part beside the face, as in box
/// against capsule.
bool may_meet(const PolytopeCapsule& pair, int face, Fine s) {
  return magnitude_of(s) == pair.local.half || magnitude_of(slope_over(pair, face)) <= (1 << 25);
}

Manifold face_manifold(const PolytopeCapsule& pair, int face, const BesideFace& beside) {
  LKS_ASSERT(face >= 0 && face < static_cast<int>(pair.local.polytope.faces.size()));
  Manifold manifold;
  manifold.normal = unit_axis(lockstone::rotate(pair.polytope.rotation, pair.face(face).normal));
  const bool low_is_deeper = slope_over(pair, face) > 0;
  const bool both = beside.low < beside.high;
  if (low_is_deeper || (both && may_meet(pair, face, beside.low)))
    add_face_point(manifold, pair, face, beside.low, face_feature(face, 0));
  if (!low_is_deeper || (both && may_meet(pair, face, beside.high)))
    add_face_point(manifold, pair, face, beside.high, face_feature(face, 1));
  return manifold.count > 0 ? manifold : Manifold{};
}

Manifold manifold_at(const PolytopeCapsule& pair, const SegmentNearest& nearest) {
  LKS_ASSERT(nearest.found && magnitude_of(nearest.s) <= pair.local.half);
  const RawVec gap = rotate(pair.polytope.rotation, nearest.gap);
  const Direction d = direction(gap.x, gap.y, gap.z);
  Manifold manifold;
  manifold.normal = d.unit;
  const RawVec on_capsule = core_point(pair, nearest.s) - along(d.unit, pair.radius);
  add_round_point(manifold, {rotate(pair.polytope.rotation, nearest.point), on_capsule},
                  pair.offset, static_cast<Fine>(d.length) - fine(pair.radius), pair.margin, 0);
  return manifold.count > 0 ? manifold : Manifold{};
}

/// The face that a gap points at within 1/64, or −1.
int facing_face(const PolytopeCapsule& pair, const RawVec& gap) {
  LKS_ASSERT(gap != RawVec{});
  const Vec3<Unit> n = direction_of(gap.x, gap.y, gap.z);
  std::int64_t most = (std::int64_t{1} << 60) - (std::int64_t{1} << 47);  // the cosine, 1 − 2^-13
  int best = -1;
  for (std::size_t i = 0; i < pair.local.polytope.faces.size(); ++i) {
    const std::int64_t lean = lockstone::dot(pair.local.polytope.faces[i].normal, n).raw;
    if (lean <= most) continue;
    most = lean;
    best = static_cast<int>(i);
  }
  return best;
}

/// Whether the part beside the face comes as near to it as the core comes to the polytope.
bool attains_face(const PolytopeCapsule& pair, int face, const BesideFace& beside, Fine distance) {
  const Fine nearest =
      std::min(height_at(pair, face, beside.low), height_at(pair, face, beside.high));
  return nearest <= distance + distance / 2048;
}

Manifold collide_apart(const PolytopeCapsule& pair, const SegmentNearest& nearest) {
  LKS_ASSERT(!is_negligible(nearest.gap));
  const int face = facing_face(pair, nearest.gap);
  if (face < 0) return manifold_at(pair, nearest);
  const BesideFace beside = beside_face(pair.local, face);
  if (beside.low > beside.high || beside.high - beside.low <= fine(pair.radius) / 16)
    return manifold_at(pair, nearest);
  const Fine deeper = slope_over(pair, face) > 0 ? beside.low : beside.high;
  if (!may_meet(pair, face, deeper) || !attains_face(pair, face, beside, nearest.distance))
    return manifold_at(pair, nearest);
  const Manifold manifold = face_manifold(pair, face, beside);
  return manifold.count > 0 ? manifold : manifold_at(pair, nearest);
}

Manifold edge_manifold(const PolytopeCapsule& pair, const SegmentEdge& best) {
  LKS_ASSERT(best.found && is_unit(best.normal));
  const Segment edge = edge_segment(pair.local.polytope, best.edge, pair.polytope.rotation, {});
  const Segment core{fine(pair.offset), pair.axis, pair.half_height};
  const ClosestParameters at = closest_parameters(edge, core);
  Manifold manifold;
  manifold.normal = unit_axis(lockstone::rotate(pair.polytope.rotation, best.normal));
  const RawVec on_capsule = point_at(core, at.on_b) - along(manifold.normal, pair.radius);
  add_round_point(manifold, {point_at(edge, at.on_a), on_capsule}, pair.offset,
                  best.separation - fine(pair.radius), pair.margin, edge_feature(best.edge));
  return manifold;
}

/// Cores farther away than this do not meet.
Fine limit_of(const PolytopeCapsule& pair) {
  return fine(pair.radius) + fine(pair.margin);
}

Manifold nearest_or_deepest(const PolytopeCapsule& pair) {
  return nearest_manifold(pair.polytope, pair.capsule, pair.offset, pair.margin);
}

bool pushes_forward(const PolytopeCapsule& pair, const Manifold& manifold) {
  const Vec3<Unit> n = rotate_inverse(pair.polytope.rotation, manifold.normal);
  return pair.local.backward.allows(-n);
}

/// The core meets the polytope, or only its plane when that is flat and the core lies in it: a face
/// whose plane the core reaches beside it, or the least way out, unless that leads out at the back.
Manifold collide_inside(const PolytopeCapsule& pair, const SegmentFace& face) {
  LKS_ASSERT(face.face >= 0);
  const BesideFace beside = beside_face(pair.local, face.face);
  const bool is_beside = beside.low <= beside.high;
  const auto height = [&](Fine s) { return height_at(pair, face.face, s); };
  if (is_beside && std::min(height(beside.low), height(beside.high)) <= k_agreement)
    return face_manifold(pair, face.face, beside);
  const Manifold out = nearest_or_deepest(pair);
  if (pushes_forward(pair, out)) return out;
  const Fine s = slope_over(pair, face.face) > 0 ? -pair.local.half : pair.local.half;
  return face_manifold(pair, face.face, is_beside ? beside : BesideFace{s, s});
}

Manifold without_backward(const PolytopeCapsule& pair, const Manifold& manifold) {
  return pushes_forward(pair, manifold) ? manifold : Manifold{};
}

/// Whether the plane along the gap separates the core from the polytope by the gap's length.
bool is_proven(const PolytopeCapsule& pair, const SegmentNearest& nearest) {
  const Vec3<Unit> n = direction_of(nearest.gap.x, nearest.gap.y, nearest.gap.z);
  const auto height = [&](Fine s) { return dot(split(pair.local.at(s)), n); };
  const Fine low = std::min(height(-pair.local.half), height(pair.local.half));
  return low - support_of(pair.local.polytope, n).height >= nearest.distance - 2 * k_agreement;
}

}  // namespace

Manifold collide_polytope_capsule(const PosedShape& polytope, const PosedShape& capsule,
                                  const Vec3<Length>& offset, Length margin) {
  LKS_ASSERT(polytope.polytope != nullptr && capsule.shape.kind == ShapeKind::capsule);
  const Polytope& p = *polytope.polytope;
  const RawVec centre = to_local(polytope.rotation, offset);
  if (p.one_sided && height_above(p.faces[0], split(centre)) < 0) return {};
  const Facing backward = p.one_sided ? Facing{p.faces[0].normal, -k_backward} : Facing{};
  const Vec3<Unit>& axis = capsule.rotation.y;
  const PolytopeCapsule pair{
      polytope,
      capsule,
      offset,
      capsule.shape.size.x,
      margin,
      capsule.shape.size.y,
      axis,
      {p, centre, to_local(polytope.rotation, axis), fine(capsule.shape.size.y), backward}};
  const Fine limit = limit_of(pair);
  SegmentHeights heights;
  measure(pair.local, heights);
  const SegmentFace face = best_face(pair.local, heights);
  LKS_ASSERT(face.face >= 0 && face.face < static_cast<int>(p.faces.size()));
  if (face.separation > limit) {
    const PolytopeFace& parting = p.faces[static_cast<std::size_t>(face.face)];
    return separated_by(lockstone::rotate(polytope.rotation, parting.normal));
  }
  SegmentEdge edge;
  if (face.separation <= 0) {
    edge = best_edge(pair.local, heights, std::min(edge_threshold(face.separation), Fine{0}));
    if (edge.found && edge.separation <= 0) return edge_manifold(pair, edge);
    if (!edge.found) return collide_inside(pair, face);
  }
  const SegmentNearest nearest = nearest_to_segment(pair.local, heights, limit);
  if (nearest.found && is_negligible(nearest.gap) && !edge.found) return collide_inside(pair, face);
  if (!nearest.found || is_negligible(nearest.gap) || !is_proven(pair, nearest))
    return without_backward(pair, nearest_or_deepest(pair));
  return without_backward(pair, collide_apart(pair, nearest));
}

}  // namespace lockstone::geometry
