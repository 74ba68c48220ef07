#include "core/collision/first_impact.h"

#include "core/collision/eroded_shape.h"
#include "core/collision/pieces.h"
#include "core/geometry/time_of_impact.h"
#include "core/math/roots.h"
#include "core/math/rotation_log.h"

namespace lockstone {
namespace {

PlacedShape placed_at_start(const MovingShape& moving) {
  return place(moving.shape, moving.asset, moving.motion.centre,
               to_matrix(moving.motion.orientation));
}

// The motion of the body as one of the piece's axes about the body's centre of mass.
struct PieceSweep {
  Sweep sweep;
  Vec3<Length> origin;

  PieceSweep(const Piece& piece, const BodyMotion& motion)
      : sweep{{motion.centre, orientation_of(piece.rotation)}, motion.translation, motion.rotation},
        origin(rotate_inverse(piece.rotation, saturated<Length>(piece.origin - motion.centre))) {}
};

// Thin pieces are stopped nearer to the surface.
TimeOfImpactLimits limits_for(Length erosion) {
  constexpr Length k_least = Length::from_raw(8);
  const Length gap = max(min(k_impact_gap, erosion / 4), k_least);
  return {gap, max(gap / 4, k_least / 4), 64};
}

// A triangle is met from its front only.
bool is_behind(const Piece& a, const Piece& b) {
  if (!b.triangle.is_triangle) return false;
  const geometry::PolytopeFace& front = b.polytope->faces.front();
  const Vec3<Length> centre = rotate_inverse(b.rotation, saturated<Length>(a.origin - b.origin));
  return dot(front.normal, centre).raw < front.offset;
}

// A half-space as a box under A that nothing can get round within one interval.
Piece as_box(const Piece& half_space, const Vec3<Position>& above) {
  constexpr Length k_half = k_max_shape_size;
  Piece box = half_space;
  box.shape = Shape::box(k_half, k_half, k_half);
  Vec3<Position> local = rotate_inverse(half_space.rotation, above - half_space.origin);
  local.y = -rounded<Position>(k_half);
  box.origin = half_space.origin + rotate(half_space.rotation, local);
  return box;
}

// Everything that A may reach while it moves relative to B.
OrientedBox way_of(const MovingShape& a, const MovingShape& b) {
  const Position radius = rounded<Position>(bounding_radius(a.shape, a.asset));
  const bool b_turns = b.motion.rotation != RotationVector{};
  const Position turned =
      b_turns ? rounded<Position>(bounding_radius(b.shape, b.asset)) * 2 : Position{};
  OrientedBox box;
  for (int i = 0; i < 3; ++i) {
    const Position half_way = Position::from_raw(a.motion.translation[i].raw / 2);
    box.centre[i] = a.motion.centre[i] + half_way;
    box.half_extents[i] = saturated<Length>(abs(half_way) + abs(b.motion.translation[i]) + radius +
                                            turned + Position::from_raw(1 << 12));
  }
  return box;
}

bool is_impact(const TimeOfImpact& time) {
  return time.state == TimeOfImpactState::hit || time.state == TimeOfImpactState::unfinished;
}

// Tries every piece of B near the way of one piece of A.
class PiecesOfB final : public PieceVisitor {
 public:
  PiecesOfB(const Piece& a, const BodyMotion& motion_a, const BodyMotion& motion_b, Impact& best)
      : a_(a), eroded_(a), sweep_a_(a, motion_a), motion_b_(motion_b), best_(best) {}

  void visit(const Piece& piece) override {
    const bool unbounded = piece.shape.kind == ShapeKind::half_space;
    const Piece b = unbounded ? as_box(piece, a_.origin) : piece;
    if (is_behind(a_, b)) return;
    const PieceSweep sweep_b(b, motion_b_);
    const TimeOfImpactLimits limits = limits_for(eroded_.depth);
    const SweptShape other{b.shape, sweep_b.sweep, b.polytope, sweep_b.origin};
    const SweptShape core{eroded_.shape, sweep_a_.sweep, eroded_.polytope_or_null(),
                          sweep_a_.origin};
    const TimeOfImpact deep = time_of_impact(core, other, limits);
    if (!is_impact(deep) || deep.fraction == Unit{}) return;
    const SweptShape whole{a_.shape, sweep_a_.sweep, a_.polytope, sweep_a_.origin};
    const TimeOfImpact full = time_of_impact(whole, other, limits);
    // What touched from the beginning stops where it has sunk in.
    const bool clean = is_impact(full) && full.fraction > Unit{};
    const Unit fraction = clean ? full.fraction : deep.fraction;
    if (best_.hit && fraction >= best_.fraction) return;
    best_ = {true, fraction, a_.part, b.part};
  }

 private:
  const Piece& a_;
  const ErodedShape eroded_;
  const PieceSweep sweep_a_;
  const BodyMotion& motion_b_;
  Impact& best_;
};

class PiecesOfA final : public PieceVisitor {
 public:
  PiecesOfA(const MovingShape& a, const MovingShape& b)
      : a_(a), b_(b), placed_b_(placed_at_start(b)), way_(way_of(a, b)) {}

  void visit(const Piece& piece) override {
    PiecesOfB others(piece, a_.motion, b_.motion, best_);
    visit_pieces(placed_b_, way_, {}, others);
  }

  [[nodiscard]] const Impact& best() const { return best_; }

 private:
  const MovingShape& a_;
  const MovingShape& b_;
  const PlacedShape placed_b_;
  const OrientedBox way_;
  Impact best_;
};

}  // namespace

Impact first_impact(const MovingShape& a, const MovingShape& b) {
  const PlacedShape placed = placed_at_start(a);
  PiecesOfA pieces(a, b);
  visit_pieces(placed, oriented_box(placed), {}, pieces);
  return pieces.best();
}

}  // namespace lockstone
