// The axis comes from GJK or EPA. Where a face looks along it, the other shape's feature is clipped
// against that face; where two edges run side by side, they touch at both ends of their common
// part; else one point is left. (D. Gregorius, Robust contact creation for physics simulations,
// 2015, takes the same steps for hulls.)
#include "core/geometry/contact/feature/collide_convex.h"

#include <algorithm>
#include <span>

#include <lockstone/assert.h>

#include "core/geometry/contact/feature/clip_feature.h"
#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// A unit axis from A to B and the separation along it.
struct ConvexAxis {
  Vec3<Unit> normal{};
  Fine separation = 0;
  RawVec on_a{};  ///< deepest points of the surfaces, from A's centre
  RawVec on_b{};
};

struct ConvexMeeting {
  const PosedShape& a;
  const PosedShape& b;
  const Vec3<Length>& offset;
  Length margin;
};

/// The anchors of overlapping points lie on the round surface, if one of the two is round.
void add_convex_point(const ConvexMeeting& pair, Manifold& manifold, const Witnesses& at,
                      Fine separation, std::uint32_t feature) {
  const bool round_a = is_round(pair.a.shape), round_b = is_round(pair.b.shape);
  Witnesses kept = at;
  if (to_separation(separation).raw <= 0 && round_a != round_b)
    kept = round_a ? Witnesses{at.on_a, at.on_a} : Witnesses{at.on_b, at.on_b};
  add_point(manifold, kept, pair.offset, separation, pair.margin, feature);
}

ConvexAxis axis_of(const CoreGap& gap, Fine separation, const GapQuery& query) {
  const Witnesses at = inflate(gap.on_a, query.a().radius, gap.on_b, query.b().radius, gap.normal);
  return {gap.normal, separation, at.on_a, at.on_b};
}

ConvexAxis nearest_axis(const ConvexMeeting& pair) {
  GapQuery query(pair.a, pair.b);
  if (query.find(fine(pair.offset)))
    return axis_of(query.gap(), query.gap().distance - query.radii(), query);
  const CoreGap gap = core_overlap(query).gap;
  return axis_of(gap, -gap.distance - query.radii(), query);
}

Fine separation_along(const ConvexMeeting& pair, const Vec3<Unit>& n) {
  return lockstone::dot(n, pair.offset).raw - reach_along(pair.a, n) - reach_along(pair.b, -n);
}

// Sides of cylinders ------------------------------------------------------------------------------

/// The capsule that has the shape's side, or the shape itself.
Shape with_round_ends(const PosedShape& posed) {
  if (posed.polytope != nullptr) return posed.shape;
  const ShapeTraits& traits = traits_of(posed.shape);
  return traits.with_round_ends != nullptr ? traits.with_round_ends(posed.shape) : posed.shape;
}

/// Whether the axis meets the shape at its side, not beyond an end by more than 2 µm, and so far
/// from the ends that no axis which is turned towards one makes a smaller overlap: turned by φ it
/// loses overlap · (1 − cos φ) and gains the distance to the end times sin φ. `point` is that of
/// the shape's axis, from its centre; the other's core is `distance` away from it.
bool is_at_side(const PosedShape& posed, const Shape& rounded, const Vec3<Unit>& normal,
                const RawVec& point, Fine distance, Fine separation) {
  constexpr Fine k_beyond = Fine{1} << (k_fine_bits - 19);
  if (rounded == posed.shape) return true;
  if (magnitude_of(dot(along(normal, distance), posed.rotation.y)) > k_beyond) return false;
  const Fine to_end = fine(rounded.size.y) - magnitude_of(dot(point, posed.rotation.y));
  return to_end + separation >= 0;
}

/// The axis square to the sides of cylinders, exact to the last bits of a normal, where it is the
/// nearest: a cylinder's side is that of a capsule, of which the axis is found in closed form.
bool find_side_axis(const ConvexMeeting& pair, ConvexAxis& found) {
  const Shape shape_a = with_round_ends(pair.a), shape_b = with_round_ends(pair.b);
  if (shape_a == pair.a.shape && shape_b == pair.b.shape) return false;
  GapQuery query({shape_a, pair.a.rotation, pair.a.polytope},
                 {shape_b, pair.b.rotation, pair.b.polytope});
  const RawVec between = fine(pair.offset);
  if (!query.find(between)) return false;
  const CoreGap& gap = query.gap();
  if (gap.distance < query.radii() / 4) return false;
  const Fine separation = gap.distance - query.radii();
  if (!is_at_side(pair.a, shape_a, gap.normal, gap.on_a, gap.distance, separation) ||
      !is_at_side(pair.b, shape_b, gap.normal, gap.on_b - between, gap.distance, separation))
    return false;
  LKS_ASSERT(is_unit(gap.normal));
  found = axis_of(gap, separation, query);
  return true;
}

// Faces -------------------------------------------------------------------------------------------

/// Whether the segment leans by more than 1/32 towards a direction.
bool is_steep(const ContactFeature& segment, const Vec3<Unit>& n) {
  const RawVec way = segment.points[1].at - segment.points[0].at;
  return magnitude_of(dot(way, n)) > static_cast<Fine>(norm(way.x, way.y, way.z) / 32);
}

/// The ends of a clipped segment that are its own. Where it leans, the round surface about it is
/// elsewhere between them.
std::span<FaceVertex> own_ends(std::span<FaceVertex> clipped) {
  std::size_t count = 0;
  for (const FaceVertex& vertex : clipped)
    if ((vertex.feature & k_crossing) == 0) clipped[count++] = vertex;
  return clipped.first(count);
}

/// The manifold from the face of one shape to the feature of the other, the normal from A to B.
Manifold on_face(const ConvexMeeting& pair, const ContactFeature& face, const ContactFeature& other,
                 bool face_is_a) {
  LKS_ASSERT(face.is_flat && is_unit(face.normal));
  const ClipFrame frame = frame_on(face);
  ClippedFeature clipped;
  const RawVec between = fine(pair.offset);
  clip(face, frame, other, face_is_a ? between : -between, clipped);
  const bool is_steep_segment = other.count == 2 && is_steep(other, face.normal);
  const std::span<FaceVertex> all = is_steep_segment ? own_ends(clipped.all()) : clipped.all();
  for (FaceVertex& vertex : all)
    vertex.z -= fine(other.radius);
  const int near = drop_far_vertices(all, pair.margin);
  const int kept = reduce_to_four(all.first(static_cast<std::size_t>(near)), clipped.shift);
  Manifold manifold;
  manifold.normal = face_is_a ? face.normal : -face.normal;
  for (int i = 0; i < kept; ++i) {
    const FaceVertex& v = clipped.vertices[static_cast<std::size_t>(i)];
    RawVec on_face = frame.origin + along(frame.u, v.x) + along(frame.v, v.y);
    if (!face_is_a) on_face = on_face + between;
    const RawVec on_other = on_face + along(frame.normal, v.z);
    const Witnesses at = face_is_a ? Witnesses{on_face, on_other} : Witnesses{on_other, on_face};
    add_convex_point(pair, manifold, at, v.z, v.feature);
  }
  LKS_ASSERT(is_manifold(manifold));
  return manifold;
}

/// Whether a face is as good an axis as the nearest: the same where they are apart, and of an
/// overlap about as short.
bool stands_for(Fine face, Fine nearest) {
  if (nearest > 0) return face >= nearest - k_face_slack;
  return nearest <= edge_threshold(face);
}

/// The features of both shapes along an axis.
struct ShownFeatures {
  ContactFeature a;
  ContactFeature b;
};

/// The manifold on the better face of the two, if one holds the deepest point. A one-sided polytope
/// pushes by its front or not at all.
bool find_face_manifold(const ConvexMeeting& pair, const ConvexAxis& axis,
                        const ShownFeatures& shown, Manifold& found) {
  struct ShownFace {
    const ContactFeature& face;
    const ContactFeature& other;
    bool is_a;
    Fine separation = -k_any_separation;
  };
  LKS_ASSERT(is_unit(axis.normal));
  ShownFace of_a{shown.a, shown.b, true}, of_b{shown.b, shown.a, false};
  for (ShownFace* choice : {&of_a, &of_b}) {
    if (!choice->face.is_flat) continue;
    const Vec3<Unit>& n = choice->face.normal;
    choice->separation = separation_along(pair, choice->is_a ? n : -n);
  }
  // A polygon has fewer sides than the face of something round.
  const bool a_first = is_round(pair.b.shape) && !is_round(pair.a.shape);
  const ShownFace& first = a_first ? of_a : of_b;
  const ShownFace& second = a_first ? of_b : of_a;
  const bool changes =
      !first.face.is_flat || second.separation > second_face_threshold(first.separation);
  for (const ShownFace* choice : {changes ? &second : &first, changes ? &first : &second}) {
    if (!choice->face.is_flat || !stands_for(choice->separation, axis.separation)) continue;
    found = on_face(pair, choice->face, choice->other, choice->is_a);
    if (attains(found, choice->separation)) return true;
  }
  return false;
}

// Edges and points --------------------------------------------------------------------------------

/// How far two edges may be aside from each other and yet meet along the normal: 1/64 of the least
/// radius of round shapes; any distance where there is none.
Fine widest_aside(const ConvexMeeting& pair, const ShownFeatures& shown) {
  Fine least = k_any_separation;
  for (const ContactFeature* feature : {&shown.a, &shown.b})
    if (feature->radius > Length{}) least = std::min(least, fine(feature->radius) / 64);
  for (const PosedShape* posed : {&pair.a, &pair.b})
    if (is_round(posed->shape)) least = std::min(least, fine(posed->shape.size.x) / 64);
  return least;
}

/// Ends of the common part of two edges that run side by side, within a degree.
bool find_edge_manifold(const ConvexMeeting& pair, const ConvexAxis& axis,
                        const ShownFeatures& shown, Manifold& found) {
  if (shown.a.count != 2 || shown.b.count != 2) return false;
  if (is_steep(shown.a, axis.normal) || is_steep(shown.b, axis.normal)) return false;
  const RawVec from_a = shown.a.points[0].at, edge_a = shown.a.points[1].at - from_a;
  const RawVec from_b = shown.b.points[0].at + fine(pair.offset);
  const RawVec edge_b = shown.b.points[1].at - shown.b.points[0].at;
  const Direction along_a = direction(edge_a.x, edge_a.y, edge_a.z);
  const Direction along_b = direction(edge_b.x, edge_b.y, edge_b.z);
  constexpr std::int64_t k_cosine = (std::int64_t{1} << 60) - (std::int64_t{1} << 47);  // 0.9°
  if (magnitude_of(lockstone::dot(along_a.unit, along_b.unit).raw) < k_cosine) return false;
  const Fine start = dot(from_b - from_a, along_a.unit), end = start + dot(edge_b, along_a.unit);
  const auto length = static_cast<Fine>(along_a.length);
  const Fine low = std::max<Fine>(0, std::min(start, end));
  const Fine high = std::min(length, std::max(start, end));
  if (high - low < length / 64) return false;
  found = {};
  found.normal = axis.normal;
  for (const Fine t : {low, high}) {
    const RawVec core_a = from_a + along(along_a.unit, t);
    const Fine s =
        std::clamp(dot(core_a - from_b, along_b.unit), Fine{0}, static_cast<Fine>(along_b.length));
    const RawVec core_b = from_b + along(along_b.unit, s);
    const Fine gap = dot(core_b - core_a, axis.normal);
    const RawVec aside = core_b - core_a - along(axis.normal, gap);
    if (norm(aside.x, aside.y, aside.z) > static_cast<std::uint64_t>(widest_aside(pair, shown)))
      return false;
    const Witnesses at = inflate(core_a, shown.a.radius, core_b, shown.b.radius, axis.normal);
    add_convex_point(pair, found, at, gap - fine(shown.a.radius) - fine(shown.b.radius),
                     t == low ? 1 : 2);
  }
  LKS_ASSERT(is_manifold(found));
  return attains(found, axis.separation);
}

Manifold single_point(const ConvexMeeting& pair, const ConvexAxis& axis) {
  Manifold manifold;
  manifold.normal = axis.normal;
  add_convex_point(pair, manifold, {axis.on_a, axis.on_b}, axis.separation, k_single_point);
  return manifold;
}

/// A sphere meets a solid at one point, whose axis is in closed form.
bool has_sphere(const ConvexMeeting& pair) {
  return pair.a.shape.kind == ShapeKind::sphere || pair.b.shape.kind == ShapeKind::sphere;
}

bool is_one_sided(const PosedShape& posed) {
  return posed.polytope != nullptr && posed.polytope->one_sided;
}

/// The front of a one-sided polytope; the other shape's origin is `offset` away. False when its
/// centre is behind the front.
bool is_before_front(const PosedShape& posed, const PosedShape& other, const Vec3<Length>& offset) {
  Vec3<Length> centre = offset;
  if (other.polytope != nullptr)
    centre += rounded<Length>(lockstone::rotate(other.rotation, other.polytope->interior));
  const PolytopeFace& front = posed.polytope->faces[0];
  return lockstone::dot(front.normal, rotate_inverse(posed.rotation, centre)).raw >= front.offset;
}

/// The axes that take the place of one that leans back through the front of a one-sided A.
class FrontAxes {
 public:
  FrontAxes(const ConvexMeeting& pair, const Vec3<Unit>& front) : pair_(pair), front_(front) {}

  [[nodiscard]] bool leans_back(const Vec3<Unit>& normal) const {
    return lockstone::dot(front_, normal).raw < 0;
  }

  /// Of the front's normal and `back` turned into the front's plane, the one of the greater
  /// separation. Of shapes that touch within the rounding, which may be all of `back`, also the
  /// nearest axis from a little farther before the front. The points remain those of `back`.
  [[nodiscard]] ConvexAxis best(const ConvexAxis& back) const {
    LKS_ASSERT(leans_back(back.normal));
    ConvexAxis best = along_normal(front_, back);
    keep_greater(best, along_normal(level(back.normal), back));
    if (magnitude_of(back.separation) > k_face_slack) return best;
    const Vec3<Unit> before = axis_before_front();
    keep_greater(best, along_normal(leans_back(before) ? level(before) : before, back));
    return best;
  }

 private:
  static void keep_greater(ConvexAxis& best, const ConvexAxis& other) {
    if (other.separation > best.separation) best = other;
  }

  [[nodiscard]] ConvexAxis along_normal(const Vec3<Unit>& normal, const ConvexAxis& back) const {
    return {normal, separation_along(pair_, normal), back.on_a, back.on_b};
  }

  /// The part of `normal` that is square to the front, as a unit vector; the front where that part
  /// is too short to have a direction.
  [[nodiscard]] Vec3<Unit> level(const Vec3<Unit>& normal) const {
    constexpr Fine k_one = Fine{1} << k_fine_bits;
    const RawVec whole = along(normal, k_one);
    const RawVec rest = whole - along(front_, dot(whole, front_));
    const Direction found = direction(rest.x, rest.y, rest.z);
    return found.length < static_cast<std::uint64_t>(k_one / 1024) ? front_ : found.unit;
  }

  [[nodiscard]] Vec3<Unit> axis_before_front() const {
    constexpr Fine k_way = Fine{1} << (k_fine_bits - 11);  // 0.49 mm
    const Vec3<Length> moved = pair_.offset + to_length(along(front_, k_way));
    return nearest_axis({pair_.a, pair_.b, moved, pair_.margin}).normal;
  }

  const ConvexMeeting& pair_;
  const Vec3<Unit>& front_;
};

}  // namespace

Manifold collide_convex(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                        Length margin) {
  const ConvexMeeting pair{a, b, offset, margin};
  const bool front_a = is_one_sided(a);
  if (front_a && !is_before_front(a, b, offset)) return {};
  ConvexAxis axis;
  if (has_sphere(pair) || !find_side_axis(pair, axis)) axis = nearest_axis(pair);
  ShownFeatures shown;
  if (front_a) {
    const Vec3<Unit> front = unit_axis(lockstone::rotate(a.rotation, a.polytope->faces[0].normal));
    const FrontAxes axes(pair, front);
    if (axes.leans_back(axis.normal)) {
      if (axis.separation > k_face_slack) return separated_by(axis.normal);
      const ConvexAxis forward = axes.best(axis);
      if (axis.separation > 0 && forward.separation < axis.separation - k_agreement)
        return separated_by(axis.normal);
      axis = forward;
    }
  }
  if (axis.separation > fine(margin) + k_face_slack) return separated_by(axis.normal);
  if (has_sphere(pair)) return single_point(pair, axis);
  find_feature(a, axis.normal, shown.a);
  find_feature(b, -axis.normal, shown.b);
  LKS_ASSERT(shown.a.count > 0 && shown.b.count > 0);
  Manifold manifold;
  if (find_face_manifold(pair, axis, shown, manifold)) return manifold;
  if (find_edge_manifold(pair, axis, shown, manifold)) return manifold;
  manifold = single_point(pair, axis);
  LKS_ASSERT(is_manifold(manifold));
  return manifold.count > 0 ? manifold : Manifold{};
}

}  // namespace lockstone::geometry
