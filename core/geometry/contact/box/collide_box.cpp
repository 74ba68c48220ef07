// Box against box: the choice among face, edge and vertex contacts.
#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/contact/box/box_corner.h"
#include "core/geometry/contact/box/box_face.h"
#include "core/geometry/contact/box/box_pair.h"
#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/manifold/nearest_manifold.h"
#include "core/geometry/distance/manifold_checks.h"

namespace lockstone::geometry {
namespace {

struct FaceChoice {
  FaceAxis a;
  FaceAxis b;
  bool b_is_reference = false;

  /// Of the better of the two.
  [[nodiscard]] Fine separation() const { return std::max(a.separation, b.separation); }
};

/// Two boxes, the choice between their faces, and which way round the manifold is wanted. Functions
/// that fill a manifold overwrite all of it.
struct BoxMeeting {
  const BoxPair& pair;
  FaceChoice faces;
  bool flip;                 ///< whether the manifold is that of B and A
  const HeldFeatures& held;  ///< of a tick ago

  bool on_face_of(bool of_b, Fine wanted, Manifold& out) const {
    return face_manifold(pair, of_b ? faces.b : faces.a, of_b, flip, wanted, held, out);
  }
  void on_reference(Manifold& out) const { (void)on_face_of(faces.b_is_reference, -1, out); }
  void on_other(Manifold& out) const { (void)on_face_of(!faces.b_is_reference, -1, out); }
  void take(const Manifold& found, Manifold& out) const { out = flip ? flipped(found) : found; }
  void part_by(const Vec3<Unit>& axis, Manifold& out) const { take(separated_by(axis), out); }
  void take_nearest(Manifold& out) const {
    take(nearest_manifold(pair.a, pair.b, pair.offset, pair.margin), out);
  }
  /// Whether the contact of two edges is there.
  [[nodiscard]] bool take_edges(const EdgeAxis& edge, Manifold& out) const {
    const EdgeContact contact = edge_contact(pair, edge);
    if (contact.crossing) take(contact.manifold, out);
    return contact.crossing;
  }
};

/// No axis separates the boxes, and a face is preferred: `out` is the manifold on the reference.
/// Where they overlap only beside the face, two edges meet after all.
void collide_overlapping(const BoxMeeting& meeting, Manifold& out) {
  LKS_ASSERT(meeting.faces.separation() <= 0);
  if (touches(out)) return;
  const EdgeAxis edge = best_edge(meeting.pair, -k_any_separation);
  if (edge.found && meeting.take_edges(edge, out)) return;
  const FaceChoice& faces = meeting.faces;
  const Fine other = std::min(faces.a.separation, faces.b.separation);
  if (other >= edge_threshold(faces.separation())) {
    meeting.on_other(out);
    if (touches(out)) return;
  }
  meeting.take_nearest(out);
}

/// The boxes are apart, and `out` is the manifold on the reference: the separation of the first
/// manifold that attains the distance is it. A face or an edge attains its axis' separation, which
/// no distance is below; all other cases involve a vertex. Where no edge separates more than the
/// faces, the reference is known not to attain it.
void collide_apart(const BoxMeeting& meeting, const EdgeAxis& edge, Manifold& out) {
  const Fine separation = edge.found ? edge.separation : meeting.faces.separation();
  LKS_ASSERT(separation > 0);
  if (!keeps(separation, meeting.pair.margin)) return meeting.part_by(edge.normal, out);
  if (edge.found && attains(out, separation)) return;
  meeting.on_other(out);
  if (attains(out, separation)) return;
  if (edge.found && meeting.take_edges(edge, out)) return;
  meeting.take(vertex_manifold(meeting.pair), out);
}

/// The face whose plane the contact had a tick ago remains the reference while its points overlap
/// no more than the other's plane shows, up to the margins of second_face_threshold. `out` is
/// scratch.
void hold_face(BoxMeeting& meeting, Manifold& out) {
  FaceChoice& faces = meeting.faces;
  const std::uint32_t held = meeting.held.first();
  LKS_ASSERT(faces.separation() <= 0);
  if (!is_of_face(held) || is_of_second_face(held) == faces.b_is_reference) return;
  (void)meeting.on_face_of(!faces.b_is_reference, -1, out);
  if (stays_reference(out, faces.separation())) faces.b_is_reference = !faces.b_is_reference;
}

/// Two edges that met a tick ago go on doing so until a face or other edges overlap clearly less:
/// boxes that lean on each other would not come to rest if the features that hold them changed in
/// each tick. Not where a face pushes nearly the same way: several points hold better than one.
/// Returns whether `out` is their manifold.
bool keep_edges(const BoxMeeting& meeting, const EdgeAxis& edge, Manifold& out) {
  LKS_ASSERT(meeting.faces.separation() <= 0);
  if (!edge.found || edge.separation > 0) return false;
  const Fine better = std::min(edge_threshold(edge.separation), Fine{0});
  if (best_edge(meeting.pair, better).found) return false;
  meeting.on_reference(out);
  const Vec3<Unit> normal = meeting.flip ? -edge.normal : edge.normal;
  return !is_better_than_held(out, normal, edge.separation) && meeting.take_edges(edge, out);
}

/// Finds the best faces of both and the reference. False where one of them parts the boxes: then
/// `out` has no points.
bool choose_faces(BoxMeeting& meeting, Manifold& out) {
  const BoxPair& pair = meeting.pair;
  LKS_ASSERT(pair.margin >= Length{});
  FaceChoice& faces = meeting.faces;
  faces.a = best_face_of_a(pair);
  if (!keeps(faces.a.separation, pair.margin)) {
    meeting.part_by(signed_axis(pair.a.rotation.column(faces.a.axis), faces.a.sign), out);
    return false;
  }
  faces.b = best_face_of_b(pair);
  if (!keeps(faces.b.separation, pair.margin)) {
    meeting.part_by(signed_axis(pair.b.rotation.column(faces.b.axis), faces.b.sign), out);
    return false;
  }
  faces.b_is_reference = faces.b.separation > second_face_threshold(faces.a.separation);
  LKS_ASSERT(faces.a.separation <= faces.separation() && faces.b.separation <= faces.separation());
  return true;
}

/// `out` is the manifold on the reference, which alone does not settle how the boxes meet.
void collide_beyond(const BoxMeeting& meeting, Manifold& out) {
  const Fine separation = meeting.faces.separation();
  LKS_ASSERT(keeps(separation, meeting.pair.margin) && is_manifold(out));
  if (separation > 0) return collide_apart(meeting, best_edge(meeting.pair, separation), out);
  const EdgeAxis edge = best_edge(meeting.pair, std::min(edge_threshold(separation), Fine{0}));
  if (!edge.found) return collide_overlapping(meeting, out);
  if (edge.separation > 0) return collide_apart(meeting, edge, out);
  // The face's plane may show more overlap than its points do: an edge that lies nearly along it
  // and protrudes beyond it overlaps most where there is no face.
  const Fine deepest = deepest_of(out);
  if (deepest <= 0 && edge.separation <= edge_threshold(deepest)) return;
  if (!meeting.take_edges(edge, out)) meeting.take_nearest(out);
}

/// Puts the manifold on the reference into `out`. Returns whether the pair is settled by it.
bool settle_on_reference(const BoxMeeting& meeting, Manifold& out) {
  const FaceChoice& faces = meeting.faces;
  const Fine separation = faces.separation();
  LKS_ASSERT(keeps(separation, meeting.pair.margin));
  if (separation > 0) {
    meeting.on_reference(out);
    return attains(out, separation);
  }
  // For a box that lies on a face, the polygon mostly shows that the boxes overlap along every axis
  // by too much for an edge.
  const Fine threshold = std::min(edge_threshold(separation), Fine{0});
  const bool shallow = -separation <= meeting.pair.half_a[faces.a.axis] / 8;
  const Fine wanted = !shallow ? -1 : threshold < 0 ? -threshold + k_agreement : 0;
  return meeting.on_face_of(faces.b_is_reference, wanted, out);
}

}  // namespace

void collide_boxes(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                   Length margin, bool flip, const HeldFeatures& held, Manifold& out) {
  const BoxPair pair = make_box_pair(a, b, offset, margin);
  BoxMeeting meeting{pair, {}, flip, held};
  if (!choose_faces(meeting, out)) return;
  if (meeting.faces.separation() <= 0) {
    hold_face(meeting, out);
    if (is_of_edges(held.first()) && keep_edges(meeting, edge_axis_of(pair, held.first()), out))
      return;
  }
  if (!settle_on_reference(meeting, out)) collide_beyond(meeting, out);
}

void collide_boxes_beyond(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                          Length margin, bool flip, const HeldFeatures& held, Manifold& out) {
  const BoxPair pair = make_box_pair(a, b, offset, margin);
  BoxMeeting meeting{pair, {}, flip, held};
  const bool meets = choose_faces(meeting, out);
  LKS_ASSERT(meets && !is_of_edges(held.first()));
  if (meets) collide_beyond(meeting, out);
}

}  // namespace lockstone::geometry
