#include "core/geometry/distance/epa/rim_overlap.h"

#include <cstdlib>
#include <limits>

#include "core/geometry/distance/epa/difference_frame.h"
#include "core/geometry/distance/gjk/fine_features.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_max_valleys = 12;
constexpr int k_max_rounds = 12;

constexpr std::int64_t k_all = std::int64_t{1} << 31;
constexpr std::int64_t k_close = (std::int64_t{1} << 30) - (std::int64_t{1} << 25);  // 0.25 rad

/// A way out along `normal`.
struct WayOut {
  Vec3<Unit> normal{};
  Fine depth = std::numeric_limits<Fine>::max();
  RawVec on_a{};  ///< from A's centre; on_a − on_b = depth · normal
  RawVec on_b{};
};

/// Whether vertices of a core are one point of it, or neighbours on a rim.
bool is_one_point(const ConvexCore& core, const Simplex& simplex, int DifferenceVertex::*index) {
  const int first = simplex.vertices[0].*index;
  for (std::size_t i = 1; i < static_cast<std::size_t>(simplex.count); ++i) {
    constexpr int k_turn = 1 << k_rim_bits;
    const int other = simplex.vertices[i].*index;
    const int turn = std::abs(first - other) % k_turn;
    const bool near =
        std::min(turn, k_turn - turn) <= 2 && first >> k_rim_bits == other >> k_rim_bits;
    if (other != first && (core.rims.count == 0 || !near)) return false;
  }
  return true;
}

/// Whether two unit vectors differ by less than 2^-25 in each component.
bool is_alike(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  constexpr std::int64_t k_alike = std::int64_t{1} << 5;
  const RawVec d = raws_of(a) - raws_of(b);
  return std::max({magnitude_of(d.x), magnitude_of(d.y), magnitude_of(d.z)}) < k_alike;
}

/// The limit of directions that approach it by steps of one ratio; the last of them if they do not.
Vec3<Unit> limit_of(const Vec3<Unit>& first, const Vec3<Unit>& second, const Vec3<Unit>& third) {
  const RawVec step = raws_of(second) - raws_of(first), next = raws_of(third) - raws_of(second);
  const std::int64_t square = narrow_dot(step, step), product = narrow_dot(step, next);
  if (product <= 0 || product >= square) return third;
  // next · ρ / (1 − ρ) for ρ = product / square, the factor at most 2^10
  const std::int64_t rest = std::max(square - product, (product >> 10) + 1);
  const auto lane = [&](std::int64_t last, std::int64_t by) {
    return last + round_divide(multiply_wide(by, product), rest);
  };
  const RawVec limit{lane(third.x.raw, next.x), lane(third.y.raw, next.y),
                     lane(third.z.raw, next.z)};
  return direction_of(limit.x, limit.y, limit.z);
}

class Descent {
 public:
  explicit Descent(GapQuery& query)
      : query_(query),
        start_(query.fine_pair().offset),
        clearance_(Fine{1} << (query.lattice().shift + 20)),
        least_fall_(Fine{1} << std::max(k_fine_bits - 27, query.lattice().shift - 4)) {}

  /// The last way is kept, not the shortest: its points lie along its normal.
  void from(const Vec3<Unit>& n) {
    const WayOut way = limit_from(n);
    if (way.depth < best_.depth) best_ = way;
  }

  /// The descents from n and −n, where those could be better.
  void try_both(const Vec3<Unit>& n) {
    for (const Vec3<Unit>& way : {n, -n}) {
      if (way == Vec3<Unit>{} || depth_along(way) > best_.depth + best_.depth / 8) continue;
      from(way);
    }
  }

  /// The depth along n, as the vertices of the lattice give it.
  [[nodiscard]] Fine depth_along(const Vec3<Unit>& n) const {
    const DifferenceVertex least = least_along(query_.lattice(), raws_of(n));
    return dot(vertex_of(query_.a(), least.a) - vertex_of(query_.b(), least.b) - start_, n);
  }

  [[nodiscard]] const WayOut& best() const { return best_; }
  [[nodiscard]] const RawVec& start() const { return start_; }

 private:
  static constexpr Fine k_none = std::numeric_limits<Fine>::max();

  /// The end of the descent from n.
  WayOut limit_from(Vec3<Unit> n) {
    WayOut here = next_of(n);
    for (int round = 0; round < k_max_rounds; ++round) {
      if (here.depth == k_none || is_alike(here.normal, n)) return here;
      const WayOut next = next_of(here.normal);
      if (next.depth == k_none) return here;
      if (next.depth >= here.depth - least_fall_) return next;
      const Vec3<Unit> limit = limit_of(n, here.normal, next.normal);
      n = next.normal;
      here = next_of(n);
      const WayOut leap = next_of(limit);
      if (leap.depth > here.depth) continue;
      n = limit;
      here = leap;
    }
    return here;
  }

  /// The way out that the closest points show when B has just left along n.
  WayOut next_of(const Vec3<Unit>& n) {
    const RawVec shift = along(n, depth_along(n) + clearance_);
    if (!query_.find(start_ + shift)) return {};
    const CoreGap& gap = query_.gap();
    WayOut way{gap.normal, dot(shift, gap.normal) - gap.distance, gap.on_a, gap.on_b - shift};
    // The normal is not so exact where a surface is curved that both points lie along it: one that
    // is a corner stays, the other moves within its face.
    const RawVec apart = along(way.normal, way.depth);
    if (is_one_point(query_.b(), query_.features(), &DifferenceVertex::b))
      way.on_a = way.on_b + apart;
    else
      way.on_b = way.on_a - apart;
    return way;
  }

  GapQuery& query_;
  RawVec start_;
  Fine clearance_;   ///< 2^-10 of the greatest distance of points
  Fine least_fall_;  ///< 2^-34 of it, at least 7 nm: less is the rounding of the lattice
  WayOut best_{};
};

/// Grows the polytope to so many vertices; true when its nearest face supports the difference.
bool grow(const LatticePair& lattice, ExpandingPolytope& polytope, int vertices) {
  constexpr std::int64_t k_steps_left = 2;
  while (polytope.vertex_count() < vertices) {
    const ExpandingFace& nearest = polytope.nearest();
    const DifferenceVertex vertex = greatest_along(lattice, nearest.normal);
    if (!polytope.sees_from_afar(vertex.point, nearest, k_steps_left)) return true;
    polytope.expand(vertex);
  }
  return false;
}

/// Descends from all valleys that could be better, but not from those whose direction is that close
/// (as a cosine, 30 bits) to the best so far.
void descend_from(const ExpandingPolytope& polytope, int shift, std::int64_t close,
                  Descent& descent) {
  std::array<const ExpandingFace*, k_max_valleys> valleys;
  const int count = polytope.find_valleys(valleys);
  for (int i = 0; i < count; ++i) {
    const ExpandingFace& face = *valleys[static_cast<std::size_t>(i)];
    const std::uint64_t steps = face.distance >> 30;
    if (static_cast<Fine>(steps << shift) >= descent.best().depth) break;
    const Vec3<Unit> n = direction_of(-face.normal.x, -face.normal.y, -face.normal.z);
    if (lockstone::dot(n, descent.best().normal).raw < close << Unit::frac_bits) descent.from(n);
  }
}

/// Whether the way out is so long that the depth hardly changes around an axis.
bool is_deep(const ConvexCore& core, Fine depth) {
  return core.rims.count != 0 && depth > fine(core.rims.radii[0]) / 64;
}

RawVec axis_of(const Rims& rims) {
  return rims.centres[1] - rims.centres[0];
}

// Layers ------------------------------------------------------------------------------------------
//
// Something small about the middle of a large cylinder or cone leaves it across the side about as
// deep in any direction. Less a layer of even thickness, the side is as much nearer in all of them,
// and the way out is the same.

/// The least and the greatest of depths.
struct DepthRange {
  Fine least = std::numeric_limits<Fine>::max();
  Fine most = std::numeric_limits<Fine>::min();
};

/// The depths along eight normals of a side; `sign` turns them from A to B.
DepthRange depths_across(const Rims& side, int sign, const Descent& descent) {
  const RawVec axis = axis_of(side), u = raws_of(side.u), v = raws_of(side.v);
  const Vec3<Unit> up = direction_of(axis.x, axis.y, axis.z);
  const auto height = static_cast<Fine>(norm(axis.x, axis.y, axis.z));
  const Vec3<Unit> slope = direction_of(height, fine(side.radii[0]) - fine(side.radii[1]), 0);
  DepthRange range;
  for (const RawVec& aside : {u, u + v, v, v - u, -u, -u - v, -v, u - v}) {
    const Vec3<Unit> out = direction_of(aside.x, aside.y, aside.z);
    const auto lane = [&](Unit x, Unit y) { return sign * (x * slope.x + y * slope.y).raw; };
    const Fine depth =
        descent.depth_along(direction_of(lane(out.x, up.x), lane(out.y, up.y), lane(out.z, up.z)));
    range = {std::min(range.least, depth), std::max(range.most, depth)};
  }
  return range;
}

/// Takes a layer off the side; the base stays.
void peel(Rims& rims, Fine layer) {
  const auto height = static_cast<Fine>(norm(axis_of(rims).x, axis_of(rims).y, axis_of(rims).z));
  const Fine radius = fine(rims.radii[0]);
  const bool cone = rims.radii[1] == Length{};
  const auto line = cone ? static_cast<Fine>(norm(height, radius, 0)) : height;
  const Fine off = round_divide(multiply_wide(layer, line), height);
  const Length left = Length::from_raw(static_cast<std::int32_t>(
      std::max<Fine>(raw::round_shift(radius - off, k_fine_per_length), 1)));
  if (cone)
    rims.centres[1] = rims.centres[0] + scaled_by_ratio(axis_of(rims), fine(left), radius);
  else
    rims.radii[1] = left;
  rims.radii[0] = left;
}

/// The best way out of a pair less a layer of one side, the valleys of whose depth are as far from
/// even as it is deep.
void try_peeled(const GapQuery& query, bool first, Descent& descent) {
  const ConvexCore &side = first ? query.a() : query.b(), &other = first ? query.b() : query.a();
  if (side.rims.count == 0) return;
  const DepthRange depths = depths_across(side.rims, first ? 1 : -1, descent);
  const Fine uneven = depths.most - depths.least + (depths.least >> 12);
  if (depths.least <= 4 * uneven || depths.least - uneven > descent.best().depth) return;
  ConvexCore peeled = side;
  peel(peeled.rims, depths.least - 2 * uneven);
  GapQuery inner(first ? peeled : other, first ? other : peeled);
  if (inner.find(descent.start())) return descent.from(inner.gap().normal);
  const DifferenceFrame frame = frame_of(inner);
  if (frame.count < 4) return;
  ExpandingPolytope polytope(frame.vertices);
  const LatticePair lattice = inner.lattice();
  grow(lattice, polytope, k_max_expanding_vertices);
  Descent within(inner);
  descend_from(polytope, lattice.shift, k_all, within);
  descent.from(within.best().normal);
}

/// The axis of a shape with rims, or the segment of a capsule, by its ends.
struct AxisEnds {
  bool any = false;
  std::array<RawVec, 2> ends{};  ///< from A's centre

  [[nodiscard]] RawVec axis() const { return ends[1] - ends[0]; }
};

AxisEnds ends_of(const ConvexCore& core, const RawVec& centre) {
  if (core.rims.count != 0)
    return {true, {centre + core.rims.centres[0], centre + core.rims.centres[1]}};
  if (core.generator_count != 1) return {};
  return {true, {centre - core.generators[0], centre + core.generators[0]}};
}

Vec3<Unit> across(const RawVec& v, const RawVec& w) {
  const RawVec both = truncated(wide_cross(v, w), 61);
  return direction_of(both.x, both.y, both.z);
}

/// The directions across one axis towards the ends of the other.
void try_across(const AxisEnds& side, const AxisEnds& other, Descent& descent) {
  const Vec3<Unit> axis = direction_of(side.axis().x, side.axis().y, side.axis().z);
  for (const RawVec& end : other.ends) {
    const RawVec from = end - side.ends[0];
    const RawVec aside = from - along(axis, dot(from, axis));
    descent.try_both(direction_of(aside.x, aside.y, aside.z));
  }
}

/// The directions along the axes: a disc touched by a rim is a valley that a small polytope may
/// miss.
void try_ends(const GapQuery& query, Descent& descent) {
  for (const ConvexCore* core : {&query.a(), &query.b()}) {
    const RawVec axis = ends_of(*core, {}).axis();
    if (axis == RawVec{}) continue;
    const Vec3<Unit> n = direction_of(axis.x, axis.y, axis.z);
    for (const Vec3<Unit>& way : {n, -n})
      if (descent.depth_along(way) < descent.best().depth) descent.from(way);
  }
}

/// The directions that symmetry singles out: across both axes, and across one of them in the plane
/// of both.
void try_symmetric(const GapQuery& query, Descent& descent) {
  const AxisEnds a = ends_of(query.a(), {}), b = ends_of(query.b(), descent.start());
  if (!a.any || !b.any) return;
  const Vec3<Unit> both = across(a.axis(), b.axis());
  descent.try_both(both);
  descent.try_both(across(a.axis(), raws_of(both)));
  descent.try_both(across(b.axis(), raws_of(both)));
  try_across(a, b, descent);
  try_across(b, a, descent);
}

}  // namespace

CoreOverlap rim_overlap(GapQuery& query, ExpandingPolytope& polytope) {
  constexpr int k_guide_vertices = 24;
  const LatticePair lattice = query.lattice();
  bool supported = grow(lattice, polytope, k_guide_vertices);
  if (supported && polytope.holds_foot(polytope.nearest())) {
    CoreGap gap =
        refine(query.fine_pair(), lattice, polytope.simplex_of(polytope.nearest()), Side::before);
    gap.normal = -gap.normal;
    return {gap, true};
  }
  Descent descent(query);
  descend_from(polytope, lattice.shift, k_close, descent);
  try_ends(query, descent);
  const Fine depth = descent.best().depth;
  if (!supported && (is_deep(query.a(), depth) || is_deep(query.b(), depth))) {
    supported = grow(lattice, polytope, k_max_expanding_vertices);
    descend_from(polytope, lattice.shift, k_all, descent);
    try_symmetric(query, descent);
    try_peeled(query, true, descent);
    try_peeled(query, false, descent);
  }
  query.return_to(descent.start());
  const WayOut& best = descent.best();
  return {{best.normal, std::max(Fine{0}, best.depth), best.on_a, best.on_b}, supported};
}

}  // namespace lockstone::geometry
