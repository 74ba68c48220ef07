// Box against box: the choice among face, edge and vertex contacts.
#include <algorithm>

#include "core/geometry/box_corner.h"
#include "core/geometry/box_face.h"
#include "core/geometry/box_pair.h"
#include "core/geometry/collide_pairs.h"
#include "core/geometry/contact_choice.h"
#include "core/geometry/nearest_manifold.h"
#include "core/geometry/preference.h"

namespace lockstone::geometry {
namespace {

struct FaceChoice {
  FaceAxis a;
  FaceAxis b;
  bool b_is_reference = false;

  /// Of the better of the two.
  [[nodiscard]] Fine separation() const { return std::max(a.separation, b.separation); }
};

Manifold manifold_on_a(const BoxPair& pair, const FaceChoice& faces) {
  return face_manifold(frame_on_a(pair, faces.a));
}

Manifold manifold_on_b(const BoxPair& pair, const FaceChoice& faces) {
  const Vec3<Length> back = -pair.offset;
  return flipped(face_manifold(frame_on_b(pair, faces.b, back)));
}

Manifold reference_manifold(const BoxPair& pair, const FaceChoice& faces) {
  return faces.b_is_reference ? manifold_on_b(pair, faces) : manifold_on_a(pair, faces);
}

Manifold other_manifold(const BoxPair& pair, const FaceChoice& faces) {
  return faces.b_is_reference ? manifold_on_a(pair, faces) : manifold_on_b(pair, faces);
}

/// No axis separates the boxes, and a face is preferred. Where they overlap only beside the face,
/// two edges meet after all.
Manifold collide_overlapping(const BoxPair& pair, const FaceChoice& faces) {
  const Manifold on_reference = reference_manifold(pair, faces);
  if (touches(on_reference)) return on_reference;
  const EdgeAxis edge = best_edge(pair, -k_any_separation);
  if (edge.found) {
    const EdgeContact contact = edge_contact(pair, edge);
    if (contact.crossing) return contact.manifold;
  }
  const Fine other = std::min(faces.a.separation, faces.b.separation);
  if (other >= edge_threshold(faces.separation())) {
    const Manifold on_other = other_manifold(pair, faces);
    if (touches(on_other)) return on_other;
  }
  return nearest_manifold(pair.a, pair.b, pair.offset, pair.margin);
}

/// The boxes are apart: the separation of the first manifold that attains the distance is it.
/// A face or an edge attains its axis' separation, which no distance is below; what remains
/// involves a vertex.
Manifold collide_apart(const BoxPair& pair, const FaceChoice& faces, const EdgeAxis& edge) {
  const Fine separation = edge.found ? edge.separation : faces.separation();
  if (!keeps(separation, pair.margin)) return separated_by(edge.normal);
  const Manifold on_reference = reference_manifold(pair, faces);
  if (attains(on_reference, separation)) return on_reference;
  const Manifold on_other = other_manifold(pair, faces);
  if (attains(on_other, separation)) return on_other;
  if (edge.found) {
    const EdgeContact contact = edge_contact(pair, edge);
    if (contact.crossing) return contact.manifold;
  }
  return vertex_manifold(pair);
}

}  // namespace

Manifold collide_boxes(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                       Length margin) {
  const BoxPair pair = make_box_pair(a, b, offset, margin);
  FaceChoice faces;
  faces.a = best_face_of_a(pair);
  if (!keeps(faces.a.separation, margin))
    return separated_by(signed_axis(a.rotation.column(faces.a.axis), faces.a.sign));
  faces.b = best_face_of_b(pair);
  if (!keeps(faces.b.separation, margin))
    return separated_by(signed_axis(b.rotation.column(faces.b.axis), faces.b.sign));
  faces.b_is_reference = faces.b.separation > second_face_threshold(faces.a.separation);

  const Fine separation = faces.separation();
  if (separation > 0) {
    const Manifold on_reference = reference_manifold(pair, faces);
    if (attains(on_reference, separation)) return on_reference;
    return collide_apart(pair, faces, best_edge(pair, separation));
  }
  const EdgeAxis edge = best_edge(pair, std::min(edge_threshold(separation), Fine{0}));
  if (!edge.found) return collide_overlapping(pair, faces);
  if (edge.separation > 0) return collide_apart(pair, faces, edge);
  const EdgeContact contact = edge_contact(pair, edge);
  return contact.crossing ? contact.manifold : nearest_manifold(a, b, offset, margin);
}

}  // namespace lockstone::geometry
