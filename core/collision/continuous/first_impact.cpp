#include "core/collision/continuous/first_impact.h"

#include <algorithm>
#include <optional>

#include <lockstone/assert.h>

#include "core/collision/continuous/piece_sweep.h"
#include "core/collision/continuous/shrunk_core.h"
#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/contact/feature/contact_feature.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

PlacedShape placed_at_start(const MovingShape& moving) {
  return place(moving.shape, moving.asset, moving.motion.start.position,
               to_matrix(moving.motion.start.orientation));
}

// Thin pieces are stopped nearer to the surface.
TimeOfImpactLimits limits_for(Length inner_radius) {
  constexpr Length k_least = Length::from_raw(8);
  const Length gap = max(min(k_impact_gap, inner_radius / 16), k_least);
  LKS_ASSERT(inner_radius >= Length{});
  return {gap, max(gap / 4, k_least / 4), 64};
}

// A half-space as a box under A that nothing can get round within one interval.
Piece as_box(const Piece& half_space, const Vec3<Position>& above) {
  constexpr Length k_half = k_max_shape_size;
  LKS_ASSERT(half_space.shape.kind == ShapeKind::half_space);
  Piece box = half_space;
  box.shape = Shape::box(k_half, k_half, k_half);
  Vec3<Position> local = rotate_inverse(half_space.rotation, above - half_space.origin);
  local.y = -rounded<Position>(k_half);
  box.origin = half_space.origin + rotate(half_space.rotation, local);
  return box;
}

// At least the angle of a turn, rad.
Position angle_of(const RotationVector& rotation) {
  Position angle{};
  for (int i = 0; i < 3; ++i)
    angle += Position::from_raw(abs(rotation[i]).raw);
  return angle;
}

// At least how far the turning of B takes any of its points that A may come to: the angle times
// their distance from its centre, or across it.
Position turned_way(const MovingShape& a, const MovingShape& b, Position radius_a) {
  const Position angle = angle_of(b.motion.rotation);
  Position reach = radius_a;
  for (int i = 0; i < 3; ++i) {
    reach += abs(a.motion.start.position[i] - b.motion.start.position[i]);
    reach += abs(a.motion.translation[i]) + abs(b.motion.translation[i]);
  }
  const Position across = rounded<Position>(bounding_radius(b.shape, b.asset)) * 2;
  LKS_ASSERT(angle >= Position{} && reach >= Position{});
  if (angle >= Position::from_integer(1)) return across;
  const auto angle_q30 = static_cast<std::int32_t>((angle.raw >> 2) + 1);
  return min(across, Position::from_raw(raw::multiply_shift(reach.raw, angle_q30, 30) + 1));
}

// Whether A's middle is where it may come to the surface within a tick: farther above it never
// does, and so far below it is contacts that push it out.
bool may_meet(const Piece& half_space, const Vec3<Position>& middle) {
  constexpr Position k_above = Position::from_integer(1400),
                     k_below = Position::from_integer(-1000);
  const Position height = rotate_inverse(half_space.rotation, middle - half_space.origin).y;
  return height > k_below && height < k_above;
}

// Everything that A may reach while it moves relative to B.
OrientedBox way_of(const MovingShape& a, const MovingShape& b) {
  const Position radius = rounded<Position>(bounding_radius(a.shape, a.asset));
  const bool b_turns = b.motion.rotation != RotationVector{};
  const Position turned = b_turns ? turned_way(a, b, radius) : Position{};
  LKS_ASSERT(radius >= Position{} && turned >= Position{});
  OrientedBox box;
  for (int i = 0; i < 3; ++i) {
    const Position half_way = Position::from_raw(a.motion.translation[i].raw / 2);
    box.centre[i] = a.motion.start.position[i] + half_way;
    box.half_extents[i] = saturated<Length>(abs(half_way) + abs(b.motion.translation[i]) + radius +
                                            turned + Position::from_raw(1 << 12));
  }
  return box;
}

// Depths in eighths of the inner radius. At the last two it is decided whether this is an impact at
// all; then the moment is that of the least depth to which A has not sunk from the beginning.
constexpr int k_half_depth = 4;
constexpr int k_last_depth = 7;

// A piece of A, sunk in by half, as it is tried against each piece of B.
struct HalfCore {
  ShrunkCore core;
  Length reach;  // at least that of any point of it from the centre that A turns about

  HalfCore(const Piece& piece, Length inner_radius, const Vec3<Length>& origin)
      : core(piece, inner_radius / 8 * k_half_depth), reach(reach_of(core, origin)) {}

 private:
  static Length reach_of(const ShrunkCore& core, const Vec3<Length>& origin) {
    // Rounded up.
    const auto length = [](const Vec3<Length>& v) {
      return static_cast<std::int64_t>(norm(v.x.raw, v.y.raw, v.z.raw)) + 1;
    };
    std::int64_t farthest = 0;
    for (const Vec3<Length>& vertex : core.polytope.vertices)
      farthest = std::max(farthest, length(vertex));
    const Length radius =
        core.is_polytope ? core.polytope.radius : bounding_radius(core.shape, nullptr);
    LKS_ASSERT(radius >= Length{});
    return Length::from_raw(raw::saturate<std::int32_t>(length(origin) + farthest + radius.raw));
  }
};

// Nothing passes a triangle from its front: a shape that has sunk in beside it, and is nearest to a
// rim from below, is stopped by the front as well.
Vec3<Unit> crossing_from_front(const Piece& b, const Vec3<Unit>& crossing) {
  if (!b.triangle.is_triangle || crossing == Vec3<Unit>{}) return crossing;
  const Vec3<Unit> front = rotate(b.rotation, b.polytope->faces.front().normal);
  return dot(front, crossing).raw > 0 ? -front : crossing;
}

// Tries every piece of B near the way of one piece of A.
class PiecesOfB final : public PieceVisitor {
 public:
  PiecesOfB(const Piece& a, const Sweep& motion_a, const Sweep& motion_b, ImpactDepth depth,
            Impact& best)
      : a_(a),
        depth_(depth),
        inner_radius_(inner_radius_of(a)),
        limits_(limits_for(inner_radius_)),
        sweep_a_(a, motion_a),
        motion_b_(motion_b),
        best_(best) {}

  void visit(const Piece& piece) override {
    const bool unbounded = piece.shape.kind == ShapeKind::half_space;
    if (unbounded && !may_meet(piece, a_.origin)) return;
    const Piece b = unbounded ? as_box(piece, a_.origin) : piece;
    if (is_behind(middle_of(a_), b) || (depth_ == ImpactDepth::half && stays_in_front(b))) return;
    const PieceSweep sweep_b(b, motion_b_);
    const SweptShape swept_b{b.shape, sweep_b.sweep, b.polytope, sweep_b.origin};
    const Hit hit = depth_ == ImpactDepth::half ? meet(swept_b) : meet_soon(swept_b);
    if (hit.time == k_never || (best_.hit && hit.time >= best_.fraction)) return;
    LKS_ASSERT(hit.time >= Unit{} && hit.time <= Unit::from_integer(1));
    const Vec3<Unit> crossing = crossing_from_front(b, hit.crossing);
    best_ = {true, hit.time, a_.part, b.part, crossing};
  }

 private:
  static constexpr Unit k_never = Unit::max();

  struct Hit {
    Unit time = k_never;
    Vec3<Unit> crossing{};
  };

  [[nodiscard]] const HalfCore& half() {
    if (!half_) half_.emplace(a_, inner_radius_, sweep_a_.origin);
    return *half_;
  }

  // Whether the half core stays in front of a triangle that stands still, so that it never comes as
  // near as an impact: its centre goes along a line, and its points turn by no more than the angle
  // times their distance.
  [[nodiscard]] bool stays_in_front(const Piece& b) {
    const bool stands =
        motion_b_.translation == Vec3<Position>{} && motion_b_.rotation == RotationVector{};
    if (!b.triangle.is_triangle || !stands) return false;
    const auto& [core, reach] = half();
    constexpr Length k_widest = Length::from_integer(256);  // sums below fit
    if (reach > k_widest) return false;
    LKS_ASSERT(reach > Length{});
    const Sweep& way = sweep_a_.sweep;
    const geometry::Fine start = height_above_front(way.start.position, b);
    const geometry::Fine end = height_above_front(way.start.position + way.translation, b);
    const geometry::Fine near = geometry::fine((limits_.target + limits_.tolerance) * 2);
    if (std::min(start, end) > geometry::fine(reach) + near) return true;
    const Position angle = angle_of(way.rotation);
    if (angle >= Position::from_integer(1)) return false;
    const geometry::Fine turned = raw::multiply_shift(angle.raw, reach.raw, 2) + 1;
    const PosedShape posed{core.shape, a_.rotation, core.polytope_or_null()};
    const Vec3<Unit> down = -rotate(b.rotation, b.polytope->faces.front().normal);
    const geometry::Fine least =
        height_above_front(a_.origin, b) - geometry::reach_along(posed, down);
    return least + std::min<geometry::Fine>(end - start, 0) - turned > near;
  }

  [[nodiscard]] Hit meet(const SweptShape& b) {
    const Unit half = time_at(k_half_depth, b);
    if (half == k_never) return {};
    const Unit deep = half > Unit{} ? half : time_at(k_last_depth, b);
    if (deep == k_never) return {};
    if (deep == Unit{}) return cross(b);
    LKS_ASSERT(deep > Unit{} && deep <= Unit::from_integer(1));
    for (const int depth : {0, 1, 2}) {
      const Unit time = time_at(depth, b);
      if (time != k_never && time > Unit{}) return {time, {}};
    }
    return {deep, {}};
  }

  // As soon as A sinks an eighth deeper than it is.
  [[nodiscard]] Hit meet_soon(const SweptShape& b) {
    for (int depth = 1; depth <= k_last_depth; ++depth) {
      const Unit time = time_at(depth, b);
      if (time == k_never) return {};
      if (time == Unit{}) continue;
      const Unit whole = depth == 1 ? time_at(0, b) : k_never;
      return {whole != k_never && whole > Unit{} ? whole : time, {}};
    }
    return cross(b);
  }

  // The moment at which the middle of A, deep in B from the beginning, runs into it too: or a rod
  // would pass through a wall that its tip was in.
  [[nodiscard]] Hit cross(const SweptShape& b) {
    for (const int share : {32, 16, 8, 1}) {
      const TimeOfImpact found = find(k_last_depth, b, Unit::from_ratio(share, 64));
      if (found.state == TimeOfImpactState::separated) return {};
      if (found.fraction > Unit{}) return {found.fraction, found.normal};
    }
    return {};
  }

  // When A, shrunk by a depth, reaches B; 0 when it overlaps from the beginning.
  [[nodiscard]] Unit time_at(int depth, const SweptShape& b) {
    const TimeOfImpact found = find(depth, b, Unit::from_integer(1));
    return found.state == TimeOfImpactState::separated ? k_never : found.fraction;
  }

  [[nodiscard]] TimeOfImpact find(int depth, const SweptShape& b, Unit share) {
    LKS_ASSERT(depth >= 0 && depth <= k_last_depth);
    const Unit whole = Unit::from_integer(1);
    if (depth == k_half_depth && share == whole) return find(half().core, b);
    return find(ShrunkCore(a_, inner_radius_ / 8 * depth, share), b);
  }

  [[nodiscard]] TimeOfImpact find(const ShrunkCore& core, const SweptShape& b) const {
    const SweptShape a{core.shape, sweep_a_.sweep, core.polytope_or_null(), sweep_a_.origin};
    return time_of_impact(a, b, limits_);
  }

  const Piece& a_;
  const ImpactDepth depth_;
  const Length inner_radius_;
  const TimeOfImpactLimits limits_;
  const PieceSweep sweep_a_;
  const Sweep& motion_b_;
  std::optional<HalfCore> half_;  // once it is asked for
  Impact& best_;
};

// Whether any piece of B touches one piece of A on their way.
class TouchingPiecesOfB final : public PieceVisitor {
 public:
  TouchingPiecesOfB(const Piece& a, const Sweep& motion_a, const Sweep& motion_b)
      : a_(a), sweep_a_(a, motion_a), motion_b_(motion_b) {}

  void visit(const Piece& piece) override {
    const bool unbounded = piece.shape.kind == ShapeKind::half_space;
    if (touched_ || (unbounded && !may_meet(piece, a_.origin))) return;
    const Piece b = unbounded ? as_box(piece, a_.origin) : piece;
    const PieceSweep sweep_b(b, motion_b_);
    const SweptShape swept_a{a_.shape, sweep_a_.sweep, a_.polytope, sweep_a_.origin};
    const SweptShape swept_b{b.shape, sweep_b.sweep, b.polytope, sweep_b.origin};
    const TimeOfImpact found = time_of_impact(swept_a, swept_b, k_touch_limits);
    touched_ = found.state != TimeOfImpactState::separated;
    LKS_ASSERT(!touched_ || found.fraction <= Unit::from_integer(1));
  }

  [[nodiscard]] bool touched() const { return touched_; }

 private:
  static constexpr TimeOfImpactLimits k_touch_limits{Length::from_raw(4), Length::from_raw(4), 256};

  const Piece& a_;
  const PieceSweep sweep_a_;
  const Sweep& motion_b_;
  bool touched_ = false;
};

class TouchingPieces final : public PieceVisitor {
 public:
  TouchingPieces(const MovingShape& a, const MovingShape& b)
      : a_(a), b_(b), placed_b_(placed_at_start(b)), way_(way_of(a, b)) {}

  void visit(const Piece& piece) override {
    if (touched_) return;
    TouchingPiecesOfB others(piece, a_.motion, b_.motion);
    visit_pieces(placed_b_, way_, {}, others);
    touched_ = others.touched();
  }

  [[nodiscard]] bool touched() const { return touched_; }

 private:
  const MovingShape& a_;
  const MovingShape& b_;
  const PlacedShape placed_b_;
  const OrientedBox way_;
  bool touched_ = false;
};

class PiecesOfA final : public PieceVisitor {
 public:
  PiecesOfA(const MovingShape& a, const MovingShape& b, ImpactDepth depth)
      : a_(a), b_(b), depth_(depth), placed_b_(placed_at_start(b)), way_(way_of(a, b)) {}

  void visit(const Piece& piece) override {
    PiecesOfB others(piece, a_.motion, b_.motion, depth_, best_);
    visit_pieces(placed_b_, way_, {}, others);
  }

  [[nodiscard]] const Impact& best() const { return best_; }

 private:
  const MovingShape& a_;
  const MovingShape& b_;
  const ImpactDepth depth_;
  const PlacedShape placed_b_;
  const OrientedBox way_;
  Impact best_;
};

}  // namespace

Impact first_impact(const MovingShape& a, const MovingShape& b, ImpactDepth depth) {
  const PlacedShape placed = placed_at_start(a);
  PiecesOfA pieces(a, b, depth);
  visit_pieces(placed, oriented_box(placed), {}, pieces);
  return pieces.best();
}

bool touch_on_way(const MovingShape& a, const MovingShape& b) {
  const PlacedShape placed = placed_at_start(a);
  TouchingPieces pieces(a, b);
  visit_pieces(placed, oriented_box(placed), {}, pieces);
  return pieces.touched();
}

}  // namespace lockstone
