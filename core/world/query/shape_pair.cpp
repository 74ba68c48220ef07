#include <utility>

#include <lockstone/assert.h>
#include <lockstone/body.h>
#include <lockstone/shape_pair.h>

#include "core/collision/continuous/piece_sweep.h"
#include "core/collision/narrow_phase/collide_bodies.h"
#include "core/collision/query/cast_placed.h"
#include "core/dynamics/state/limits.h"
#include "core/geometry/distance/gjk/gjk.h"

namespace lockstone {
namespace {

constexpr Position k_farthest_frames = Position::from_integer(1000);
constexpr Position k_farthest_parts = Position::from_integer(2000);
constexpr Length k_least_gap = Length::from_raw(8);
constexpr Length k_greatest_gap = Length::from_integer(1);
constexpr Length k_greatest_margin = Length::from_integer(64);

bool is_pose(const Transform& pose) {
  return is_within(pose.position, k_world_limit) && has_direction(pose.orientation);
}

// Of shapes that pass `validate`.
bool is_convex(ShapeKind kind) {
  return is_primitive(kind) || kind == ShapeKind::hull;
}
// A compound with meshes is not.
bool is_solid(const ShapeAt& at) {
  if (at.shape.kind != ShapeKind::compound) return is_convex(at.shape.kind);
  return at.asset != nullptr && at.asset->geometry().triangles() == nullptr;
}
bool is_half_space(const Shape& shape) {
  return shape.kind == ShapeKind::half_space;
}

bool is_shape(const ShapeAt& at) {
  if (validate(at.shape) != Status::ok || !is_pose(at.pose)) return false;
  if (!is_asset(at.shape.kind)) return true;
  return at.asset != nullptr && at.asset->kind() == at.shape.kind &&
         at.asset->id() == at.shape.asset;
}

PlacedShape placed_at(const ShapeAt& at) {
  const geometry::AssetGeometry* asset =
      is_asset(at.shape.kind) ? geometry::geometry_of(at.asset) : nullptr;
  return {at.shape, asset, at.pose.position, to_matrix(normalized(at.pose.orientation)),
          at.pose.position};
}

// Two shapes, of which one at least is solid, a half-space near the other.
struct PlacedPair {
  PlacedShape a;
  PlacedShape b;
  bool is_valid = false;

  PlacedPair(const ShapeAt& at_a, const ShapeAt& at_b) {
    if (!is_shape(at_a) || !is_shape(at_b)) return;
    if (!is_solid(at_a) && !is_solid(at_b)) return;
    const PlacedShape placed_a = placed_at(at_a), placed_b = placed_at(at_b);
    a = brought_near(placed_a, placed_b.origin);
    b = brought_near(placed_b, placed_a.origin);
    is_valid = is_within(b.origin - a.origin, k_farthest_frames);
  }
};

// Calls `f(piece_a, piece_b)` for all pieces whose bounds come as near as `reach` says at the time,
// ascending by the part of A, then of B.
template <class F>
void for_each_near_pair(const PlacedPair& pair, const Length& reach, F&& f) {
  auto with_b = [&](const Piece& a) {
    auto with_a = [&](const Piece& b) {
      if (is_within(b.origin - a.origin, k_farthest_parts)) f(a, b);
    };
    EachPiece<decltype(with_a)> pieces_of_b(with_a);
    visit_pieces(pair.b, is_half_space(a.shape) ? oriented_box(pair.b) : oriented_box(a), reach,
                 pieces_of_b);
  };
  EachPiece<decltype(with_b)> pieces_of_a(with_b);
  visit_pieces(pair.a, oriented_box(is_half_space(pair.b.shape) ? pair.a : pair.b), reach,
               pieces_of_a);
}

// A manifold between bodies whose centres are those of the placed shapes.
ShapeManifold to_manifold(const PlacedPair& pair, const PartContact& contact, bool flipped) {
  const Manifold& from = contact.manifold;
  LKS_ASSERT(from.count > 0 && from.count <= k_max_manifold_points);
  ShapeManifold to{
      from.normal, contact.part_a, contact.part_b, static_cast<std::uint32_t>(from.count), {}};
  for (std::size_t i = 0; i < to.count; ++i) {
    const ManifoldPoint& point = from.points[i];
    to.points[i] = {pair.a.centre + rounded<Position>(point.anchor_a),
                    pair.b.centre + rounded<Position>(point.anchor_b), point.separation};
    if (flipped) std::swap(to.points[i].point_a, to.points[i].point_b);
  }
  if (flipped) {
    to.normal = -to.normal;
    std::swap(to.part_a, to.part_b);
  }
  return to;
}

// The motion of a shape's frame; without a way where `motion` is not valid.
struct FrameSweep {
  PlacedShape placed;
  Sweep sweep;
  bool is_valid = false;

  explicit FrameSweep(const ShapeMotion& motion) {
    const ShapeAt& start = motion.start;
    if (!is_shape(start) || !is_solid(start) || !is_pose(motion.end)) return;
    placed = placed_at(start);
    const Quat from = normalized(start.pose.orientation);
    sweep = {{start.pose.position, from},
             motion.end.position - start.pose.position,
             rotation_between(from, normalized(motion.end.orientation))};
    is_valid = is_within(sweep.translation, rounded<Position>(k_max_cast));
  }
};

// Where a piece is at a fraction of its way.
Piece moved_piece(const Piece& piece, const PieceSweep& by, Unit fraction) {
  const Transform pose = pose_at(by.sweep, fraction);
  Piece moved = piece;
  moved.origin = apply(pose, by.origin);
  moved.rotation = to_matrix(pose.orientation);
  return moved;
}

// Looks for the first impact of all pairs of pieces.
class FirstOfParts {
 public:
  FirstOfParts(const FrameSweep& a, const FrameSweep& b, Length gap)
      : a_(a), b_(b), limits_{gap, gap / 4, 256} {}

  [[nodiscard]] ShapeImpact find() {
    auto with_b = [&](const Piece& a) {
      auto with_a = [&](const Piece& b) { compare(a, b); };
      EachPiece<decltype(with_a)> pieces_of_b(with_a);
      visit_pieces(b_.placed, oriented_box(b_.placed), {}, pieces_of_b);
    };
    EachPiece<decltype(with_b)> pieces_of_a(with_b);
    visit_pieces(a_.placed, oriented_box(a_.placed), {}, pieces_of_a);
    return best_;
  }

 private:
  void compare(const Piece& a, const Piece& b) {
    const PieceSweep way_a(a, a_.sweep), way_b(b, b_.sweep);
    const SweptShape swept_a{a.shape, way_a.sweep, a.polytope, way_a.origin};
    const SweptShape swept_b{b.shape, way_b.sweep, b.polytope, way_b.origin};
    const TimeOfImpact found = time_of_impact(swept_a, swept_b, limits_);
    if (found.state == TimeOfImpactState::separated) return;
    if (best_.hit && found.fraction >= best_.fraction) return;
    best_ = {true,
             found.state == TimeOfImpactState::overlapping,
             a.part,
             b.part,
             found.fraction,
             found.normal,
             {}};
    if (best_.overlapping) return;
    const Piece at_a = moved_piece(a, way_a, found.fraction);
    const Piece at_b = moved_piece(b, way_b, found.fraction);
    const ClosestPoints closest =
        distance(at_a.posed(), at_b.posed(), saturated<Length>(at_b.origin - at_a.origin));
    best_.point_a = at_a.origin + rounded<Position>(closest.point_a);
  }

  const FrameSweep& a_;
  const FrameSweep& b_;
  const TimeOfImpactLimits limits_;
  ShapeImpact best_;
};

}  // namespace

Result<ShapeDistance> shape_distance(const ShapeAt& a, const ShapeAt& b, Length reach) {
  const PlacedPair pair(a, b);
  if (!pair.is_valid || reach < Length{} || reach > k_max_cast) return Status::invalid_argument;
  ShapeDistance best;
  Position nearest = rounded<Position>(reach);
  Length still = reach;
  for_each_near_pair(pair, still, [&](const Piece& pa, const Piece& pb) {
    const ClosestPoints found =
        distance(pa.posed(), pb.posed(), saturated<Length>(pb.origin - pa.origin));
    if (best.found ? found.distance >= nearest : found.distance > nearest) return;
    nearest = found.distance;
    still = saturated<Length>(nearest) + Length::from_raw(1);
    best = {true, found.overlapping, pa.part, pb.part, found.distance, {}, {}, {}};
    if (found.overlapping) return;
    best.normal = found.normal;
    best.point_a = pa.origin + rounded<Position>(found.point_a);
    best.point_b = pb.origin + rounded<Position>(found.point_b);
  });
  return best;
}

Result<std::size_t> shape_contacts(const ShapeAt& a, const ShapeAt& b, Length margin,
                                   std::span<ShapeManifold> out) {
  const bool flipped = !is_solid(a);  // only the second may have no inside
  const PlacedPair pair(flipped ? b : a, flipped ? a : b);
  if (!pair.is_valid || margin < Length{} || margin > k_greatest_margin)
    return Status::invalid_argument;
  PartContacts found;  // large: filled once
  collide_bodies(pair.a, pair.b, margin, found);
  std::size_t count = 0;
  for (const PartContact& contact : found) {
    if (count == out.size()) break;
    out[count++] = to_manifold(pair, contact, flipped);
  }
  return count;
}

Result<ShapeImpact> shape_cast(const ShapeAt& a, const ShapeAt& b,
                               const Vec3<Length>& translation) {
  const PlacedPair pair(a, b);
  if (!pair.is_valid || !is_convex(b.shape.kind) || !is_within(translation, k_max_cast))
    return Status::invalid_argument;
  const PlacedShapeHit hit = cast_shape(pair.a, pair.b, translation, Unit::from_integer(1));
  if (!hit.hit) return ShapeImpact{};
  const bool overlapping = hit.fraction == Unit{} && bodies_overlap(pair.a, pair.b);
  return ShapeImpact{true, overlapping, hit.part, 0, hit.fraction, hit.normal, hit.point};
}

Result<ShapeImpact> shape_impact(const ShapeMotion& a, const ShapeMotion& b, Length gap) {
  const FrameSweep sweep_a(a), sweep_b(b);
  if (!sweep_a.is_valid || !sweep_b.is_valid || gap < k_least_gap || gap > k_greatest_gap ||
      !is_within(b.start.pose.position - a.start.pose.position, k_farthest_frames))
    return Status::invalid_argument;
  return FirstOfParts(sweep_a, sweep_b, gap).find();
}

}  // namespace lockstone
