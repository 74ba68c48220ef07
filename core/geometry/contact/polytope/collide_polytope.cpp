// Polytope against polytope or box: the choice among face, edge and vertex contacts.
#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/manifold/nearest_manifold.h"
#include "core/geometry/contact/polytope/polytope_collide.h"
#include "core/geometry/contact/polytope/polytope_edges.h"
#include "core/geometry/contact/polytope/polytope_face.h"
#include "core/geometry/contact/polytope/polytope_point.h"
#include "core/geometry/convex/polytope_box.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// A pair that no face separates by more than the margin, and the findings so far.
struct Meeting {
  const PosedShape& posed_a;
  const PosedShape& posed_b;
  const PolytopePair& pair;
  const Vec3<Length>& back;  ///< the reversed offset
  Facing toward_front;       ///< limits −n of axes n in A's frame; allows all but of one-sided A
  Facing of_b;               ///< likewise, for the normals of B in its frame
  const HeldFeatures& held;  ///< of a tick ago
  FaceSupport a{};
  FaceSupport b{};
  Witness of_a{};  ///< points of A in B's frame
  Witness of_b_points{};

  bool holds_other_face = false;  ///< the reference is the face that is not preferred

  [[nodiscard]] bool b_is_reference() const {
    if (a.face < 0 || b.face < 0) return a.face < 0;
    return (b.separation > second_face_threshold(a.separation)) != holds_other_face;
  }
  [[nodiscard]] Fine separation() const {
    if (a.face < 0) return b.separation;
    return b.face < 0 ? a.separation : std::max(a.separation, b.separation);
  }
  /// Of the face that is not the reference.
  [[nodiscard]] Fine other_separation() const {
    if (a.face < 0 || b.face < 0) return -k_any_separation;
    return b_is_reference() ? a.separation : b.separation;
  }
  [[nodiscard]] PolytopeFaceMeeting on_a() const {
    return {pair.from_a, pair.offset, pair.margin, a, false, held};
  }
  [[nodiscard]] PolytopeFaceMeeting on_b() const {
    return {pair.from_b, back, pair.margin, b, true, held};
  }
};

Manifold face_manifold_of(const Meeting& meeting, bool b_is_reference,
                          Fine highest = k_any_separation) {
  if (!b_is_reference)
    return meeting.a.face < 0 ? Manifold{} : face_manifold(meeting.on_a(), highest);
  return meeting.b.face < 0 ? Manifold{} : flipped(face_manifold(meeting.on_b(), highest));
}

Manifold reference_manifold(const Meeting& meeting) {
  return face_manifold_of(meeting, meeting.b_is_reference());
}

Manifold other_manifold(const Meeting& meeting) {
  return face_manifold_of(meeting, !meeting.b_is_reference());
}

Manifold deepest_vertex(const Meeting& meeting) {
  if (meeting.b_is_reference()) return flipped(support_manifold(meeting.on_b()));
  return support_manifold(meeting.on_a());
}

struct CrossedEdges {
  Manifold manifold;
  bool crossing = false;  ///< the closest points lie inside both edges
};

/// One point between two edges, square to both.
CrossedEdges edge_manifold(const PolytopePair& pair, const EdgeSupport& edge) {
  LKS_ASSERT(edge.found);
  const Segment a = edge_segment(pair.from_a.own, edge.edge_a, pair.rotation_a, {});
  const Segment b = edge_segment(pair.from_b.own, edge.edge_b, pair.rotation_b, fine(pair.offset));
  const ClosestParameters at = closest_parameters(a, b);
  CrossedEdges result;
  result.crossing = at.crossing;
  result.manifold.normal = unit_axis(lockstone::rotate(pair.rotation_a, edge.normal));
  const std::uint32_t feature = feature_of_edges(edge.edge_a, edge.edge_b);
  add_point(result.manifold, {point_at(a, at.on_a), point_at(b, at.on_b)}, pair.offset,
            edge.separation, pair.margin, feature);
  return result;
}

/// Whether the edges are where the polytopes overlap least: uneven ones hide axes.
bool is_sure(const PolytopePair& pair, const CrossedEdges& crossed) {
  return crossed.crossing && !is_uneven(pair.from_a.own) && !is_uneven(pair.from_b.own);
}

/// The vertex of either polytope that is nearest to the other.
struct NearestVertex {
  NearestPoint at;
  bool of_b = true;
  int vertex = 0;
  Fine limit = 0;
};

void find_nearest_vertex(const PolytopeView& view, const FaceSupport& face, bool of_b,
                         NearestVertex& best) {
  LKS_ASSERT(face.face < static_cast<int>(view.own.faces.size()));
  const int count = static_cast<int>(view.other.vertices.size());
  for (int i = 0; i < count; ++i) {
    const RawVec point = view.to_own(view.other.vertices[static_cast<std::size_t>(i)]);
    const PolytopeFace& plane = view.own.faces[static_cast<std::size_t>(std::max(face.face, 0))];
    if (height_above(plane, split(point)) > best.limit) continue;
    const NearestPoint at = nearest_point(view.own, point, best.limit);
    if (!at.found || at.inside || (best.at.found && at.distance >= best.at.distance)) continue;
    best = {at, of_b, i, at.distance};
  }
}

/// Whether the plane along the manifold's normal separates by as much as its points are apart.
bool is_proven(const PolytopePair& pair, const Manifold& manifold, Fine distance) {
  const Vec3<Unit> n = rotate_inverse(pair.rotation_a, manifold.normal);
  return separation_on(pair, n) >= distance - 2 * k_agreement;
}

/// Polytopes apart whose nearest features include a vertex. A gap so short that it has no direction
/// in these lanes, and features that are not the nearest, prove nothing: then GJK decides.
Manifold vertex_manifold(const Meeting& meeting) {
  const PolytopePair& pair = meeting.pair;
  NearestVertex best;
  best.limit = fine(pair.margin);
  find_nearest_vertex(pair.from_a, meeting.a, true, best);
  find_nearest_vertex(pair.from_b, meeting.b, false, best);
  const auto nearest = [&] {
    return nearest_manifold(meeting.posed_a, meeting.posed_b, pair.offset, pair.margin);
  };
  if (!best.at.found || best.at.gap == RawVec{}) return nearest();
  Manifold manifold;
  const Mat3& rotation = best.of_b ? pair.rotation_a : pair.rotation_b;
  const RawVec gap = rotate(rotation, best.at.gap);
  const RawVec foot = rotate(rotation, best.at.point);
  const Direction d = direction(gap.x, gap.y, gap.z);
  const RawVec centre = fine(pair.offset);
  manifold.normal = best.of_b ? d.unit : -d.unit;
  const Witnesses witnesses =
      best.of_b ? Witnesses{foot, foot + gap} : Witnesses{centre + foot + gap, centre + foot};
  LKS_ASSERT(is_unit(manifold.normal) && d.length > 0);
  add_point(
      manifold, witnesses, pair.offset, static_cast<Fine>(d.length), pair.margin,
      k_hull_vertex_bits | (best.of_b ? k_hull_of_b : 0) | static_cast<std::uint32_t>(best.vertex));
  return is_proven(pair, manifold, static_cast<Fine>(d.length)) ? manifold : nearest();
}

/// No face and no edges are met where the polytopes overlap: the least way out, unless that leads
/// out at the back of one-sided A.
Manifold least_way_out(const Meeting& meeting) {
  const PolytopePair& pair = meeting.pair;
  const Manifold manifold =
      nearest_manifold(meeting.posed_a, meeting.posed_b, pair.offset, pair.margin);
  const Vec3<Unit> n = rotate_inverse(pair.rotation_a, manifold.normal);
  return meeting.toward_front.allows(-n) ? manifold : deepest_vertex(meeting);
}

/// Whether an axis of this separation stands beside the best one of all faces: not deeper by more
/// than a tenth and k_edge_margin.
bool may_stand_for(Fine separation, Fine best) {
  return edge_threshold(separation) >= best;
}

/// No axis separates. Where the polytopes overlap only beside the face, two edges meet after all,
/// or the other face does.
Manifold collide_overlapping(const Meeting& meeting) {
  LKS_ASSERT(meeting.separation() <= 0);
  const Manifold on_reference = reference_manifold(meeting);
  if (touches(on_reference)) return on_reference;
  const EdgeSupport edge = best_edge(meeting.pair, -k_any_separation, meeting.toward_front,
                                     meeting.of_a, meeting.of_b_points);
  if (edge.found && may_stand_for(edge.separation, meeting.separation())) {
    const CrossedEdges crossed = edge_manifold(meeting.pair, edge);
    if (is_sure(meeting.pair, crossed)) return crossed.manifold;
  }
  if (may_stand_for(meeting.other_separation(), meeting.separation())) {
    const Manifold on_other = other_manifold(meeting);
    if (touches(on_other)) return on_other;
  }
  return least_way_out(meeting);
}

/// The manifold of a face, if that is where the polytopes are nearest and pushes to the front of
/// one-sided A; else one without points. Beside a rim several faces are as near, and one of them
/// may lean back; a face clipped by the other polytope may be as near too.
Manifold nearest_face(const Meeting& meeting, bool b_is_reference, Fine separation) {
  const FaceSupport& face = b_is_reference ? meeting.b : meeting.a;
  LKS_ASSERT(separation > 0);
  if (face.face < 0 || face.separation < separation - k_face_slack) return {};
  const Manifold manifold = face_manifold_of(meeting, b_is_reference, separation + k_face_slack);
  if (!attains(manifold, separation)) return {};
  const Vec3<Unit> n = rotate_inverse(meeting.pair.rotation_a, manifold.normal);
  return meeting.toward_front.allows(-n) ? manifold : Manifold{};
}

/// Some axis separates: the first manifold that attains the distance is it. A case that is neither
/// a face nor two crossing edges involves a vertex. Where no edge separates more than the faces,
/// the reference is known not to be nearest.
Manifold collide_apart(const Meeting& meeting, const EdgeSupport& edge) {
  const Fine separation = edge.found ? edge.separation : meeting.separation();
  LKS_ASSERT(separation > 0);
  if (!keeps(separation, meeting.pair.margin)) {
    return edge.found ? separated_by(lockstone::rotate(meeting.pair.rotation_a, edge.normal))
                      : Manifold{};
  }
  const bool b_is_reference = meeting.b_is_reference();
  if (edge.found) {
    const Manifold on_reference = nearest_face(meeting, b_is_reference, separation);
    if (on_reference.count > 0) return on_reference;
  }
  const Manifold on_other = nearest_face(meeting, !b_is_reference, separation);
  if (on_other.count > 0) return on_other;
  if (edge.found) {
    const CrossedEdges crossed = edge_manifold(meeting.pair, edge);
    if (crossed.crossing) return crossed.manifold;
  }
  return vertex_manifold(meeting);
}

/// Of one-sided A: faces that would push B through it are no answer to an overlap.
void forget_backward_faces(Meeting& meeting) {
  const auto& faces = meeting.pair.from_b.own.faces;
  if (meeting.of_b.allows(faces[static_cast<std::size_t>(meeting.b.face)].normal)) return;
  meeting.b = best_face(meeting.pair.from_b, meeting.of_b, k_any_separation, meeting.of_a);
}

/// The shape whose face a held contact had goes on giving the reference while the points on it
/// overlap no more than the other's plane shows, up to the margins of second_face_threshold.
void hold_face(Meeting& meeting) {
  const std::uint32_t held = meeting.held.first();
  if (meeting.a.face < 0 || meeting.b.face < 0 || !is_of_hull_face(held)) return;
  LKS_ASSERT(!meeting.holds_other_face && meeting.separation() <= 0);
  if (((held & k_hull_of_b) != 0) == meeting.b_is_reference()) return;
  meeting.holds_other_face = stays_reference(other_manifold(meeting), meeting.separation());
}

/// Two edges that met a tick ago go on doing so until a face or other edges overlap clearly less,
/// as those of boxes (collide_box.cpp). Without points where they do not.
Manifold kept_edges(const Meeting& meeting) {
  const PolytopePair& pair = meeting.pair;
  LKS_ASSERT(meeting.separation() <= 0);
  if (!is_of_hull_edges(meeting.held.first())) return {};
  const EdgeSupport edge = held_edge(pair, meeting.held.first(), meeting.toward_front);
  if (!edge.found || edge.separation > 0) return {};
  const Fine better = std::min(edge_threshold(edge.separation), Fine{0});
  if (best_edge(pair, better, meeting.toward_front, meeting.of_a, meeting.of_b_points).found)
    return {};
  const CrossedEdges crossed = edge_manifold(pair, edge);
  if (!is_sure(pair, crossed)) return {};
  const bool is_face_better =
      is_better_than_held(reference_manifold(meeting), crossed.manifold.normal, edge.separation);
  return is_face_better ? Manifold{} : crossed.manifold;
}

Manifold collide_meeting(Meeting& meeting) {
  const PolytopePair& pair = meeting.pair;
  const auto edge_above = [&](Fine threshold) {
    return best_edge(pair, threshold, meeting.toward_front, meeting.of_a, meeting.of_b_points);
  };
  if (meeting.separation() > 0) {
    const Manifold on_reference =
        nearest_face(meeting, meeting.b_is_reference(), meeting.separation());
    if (on_reference.count > 0) return on_reference;
    return collide_apart(meeting, edge_above(meeting.separation()));
  }
  if (pair.from_a.own.one_sided) forget_backward_faces(meeting);
  hold_face(meeting);
  const Manifold kept = kept_edges(meeting);
  if (kept.count > 0) return kept;
  const EdgeSupport edge = edge_above(std::min(edge_threshold(meeting.separation()), Fine{0}));
  if (!edge.found) return collide_overlapping(meeting);
  if (edge.separation > 0) return collide_apart(meeting, edge);
  const CrossedEdges crossed = edge_manifold(pair, edge);
  return is_sure(pair, crossed) ? crossed.manifold : least_way_out(meeting);
}

Manifold collide_pair(const PosedShape& a, const PosedShape& b, const PolytopePair& pair,
                      const Facing& toward_front, const Facing& of_b, const HeldFeatures& held) {
  const Vec3<Length> back = -pair.offset;
  Meeting meeting{a, b, pair, back, toward_front, of_b, held};
  const Fine enough = fine(pair.margin) + k_agreement;
  constexpr Facing any{};
  const Facing own{-toward_front.direction, toward_front.limit};  // n · front ≥ −limit
  meeting.a = best_face(pair.from_a, own, enough, meeting.of_b_points);
  if (!keeps(meeting.a.separation, pair.margin)) {
    LKS_ASSERT(meeting.a.face >= 0);
    const auto& face = pair.from_a.own.faces[static_cast<std::size_t>(meeting.a.face)];
    return separated_by(lockstone::rotate(pair.rotation_a, face.normal));
  }
  meeting.b = best_face(pair.from_b, any, enough, meeting.of_a);
  if (!keeps(meeting.b.separation, pair.margin)) {
    LKS_ASSERT(meeting.b.face >= 0);
    const auto& face = pair.from_b.own.faces[static_cast<std::size_t>(meeting.b.face)];
    return separated_by(-lockstone::rotate(pair.rotation_b, face.normal));
  }
  return collide_meeting(meeting);
}

/// Of one-sided A. Normals that point backward through it do not push. Shapes that touch are as
/// near along many directions: where one that leans back was found, GJK decides.
Manifold collide_front(const PosedShape& a, const PosedShape& b, const PolytopePair& pair,
                       const HeldFeatures& held) {
  const PolytopeView& view = pair.from_a;
  const PolytopeFace& front = view.own.faces[0];
  LKS_ASSERT(view.own.one_sided && is_unit(front.normal));
  const RawVec centre = view.to_own(view.other.interior);
  if (height_above(front, split(centre)) < 0) return {};
  const Vec3<Unit> n = front.normal;
  const Manifold manifold =
      collide_pair(a, b, pair, {n, -k_backward}, {view.to_other(n), -k_backward}, held);
  const Vec3<Unit> world = lockstone::rotate(pair.rotation_a, n);
  const auto leans_back = [&](const Manifold& m) {
    return lockstone::dot(m.normal, world).raw < k_backward;
  };
  if (!leans_back(manifold)) return manifold;
  if (manifold.count == 0) return {};
  const Manifold nearest = nearest_manifold(a, b, pair.offset, pair.margin);
  return leans_back(nearest) ? Manifold{} : nearest;
}

Manifold collide_views(const PosedShape& a, const PosedShape& b, const PolytopePair& pair,
                       const HeldFeatures& held) {
  return pair.from_a.own.one_sided ? collide_front(a, b, pair, held)
                                   : collide_pair(a, b, pair, {}, {}, held);
}

}  // namespace

Manifold collide_polytopes(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                           Length margin, const HeldFeatures& held) {
  LKS_ASSERT(a.polytope != nullptr && (b.polytope != nullptr || b.shape.kind == ShapeKind::box));
  if (b.polytope != nullptr) {
    return collide_views(
        a, b, make_polytope_pair(*a.polytope, a.rotation, *b.polytope, b.rotation, offset, margin),
        held);
  }
  const BoxPolytope box(b.shape.size);
  const Polytope view = box.view();
  return collide_views(
      a, b, make_polytope_pair(*a.polytope, a.rotation, view, b.rotation, offset, margin), held);
}

}  // namespace lockstone::geometry
