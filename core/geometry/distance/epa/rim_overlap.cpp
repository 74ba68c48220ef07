#include "core/geometry/distance/epa/rim_overlap.h"

#include <cstdlib>
#include <limits>

#include "core/geometry/distance/epa/face_directions.h"
#include "core/geometry/distance/epa/ring_search.h"
#include "core/geometry/distance/gjk/fine_features.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_max_valleys = 12;
constexpr int k_max_rounds = 12;

/// A way out along `normal`.
struct WayOut {
  Vec3<Unit> normal{};
  Fine depth = std::numeric_limits<Fine>::max();
  RawVec on_a{};  ///< from A's centre; on_a − on_b = depth · normal
  RawVec on_b{};
  Fine aside = 0;  ///< how far one of the two may be beside its surface
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

Fine extent_of(const ConvexCore& core) {
  return std::max({core.extent.x, core.extent.y, core.extent.z}) + fine(core.radius);
}

/// How far outside B is put: 2^-10 of the greatest distance of points, so that the normals of
/// features that the lattice moves are exact enough. But no more than 1/64 of the smaller shape,
/// beside which a longer way would show other features than those that touch, and at least 2^-16.
Fine clearance_of(const GapQuery& query) {
  const Fine step = Fine{1} << query.lattice().shift;
  const Fine smaller = std::min(extent_of(query.a()), extent_of(query.b()));
  return std::clamp(smaller / 64, step << 14, step << 20);
}

class Descent {
 public:
  explicit Descent(GapQuery& query)
      : query_(query),
        start_(query.fine_pair().offset),
        clearance_(clearance_of(query)),
        least_fall_(Fine{1} << std::max(k_fine_bits - 27, query.lattice().shift - 4)) {}

  /// The last way is kept, not the shortest: its points lie along its normal.
  void from(const Vec3<Unit>& n) {
    const WayOut way = limit_from(n);
    if (way.depth < best_.depth) best_ = way;
  }

  /// The descent from n if it is a shorter way already.
  void try_from(const Vec3<Unit>& n) {
    if (depth_along(n) < best_.depth) from(n);
  }

  /// Where the depth is even, the last direction and the one before may differ, and the points with
  /// them: goes on as long as they come nearer to the surfaces and the way is no longer.
  void settle() {
    for (int round = 0; round < k_max_rounds && best_.aside > k_no_distance; ++round) {
      const WayOut next = next_of(best_.normal);
      if (next.depth > best_.depth + least_fall_ || next.aside >= best_.aside) return;
      best_ = next;
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
    const RawVec apart = along(way.normal, way.depth), off = way.on_a - way.on_b - apart;
    way.aside = static_cast<Fine>(norm(off.x, off.y, off.z));
    // The normal is not so exact where a surface is curved that both points lie along it: one that
    // is a corner stays, the other moves within its face.
    if (is_one_point(query_.b(), query_.features(), &DifferenceVertex::b))
      way.on_a = way.on_b + apart;
    else
      way.on_b = way.on_a - apart;
    return way;
  }

  GapQuery& query_;
  RawVec start_;
  Fine clearance_;
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

/// Descends from all valleys that could be better, but not from those whose direction is within
/// 1/16 rad of the best so far.
void descend_from(const ExpandingPolytope& polytope, int shift, Descent& descent) {
  constexpr std::int64_t k_close = (std::int64_t{1} << 30) - (std::int64_t{1} << 21);
  std::array<const ExpandingFace*, k_max_valleys> valleys;
  const int count = polytope.find_valleys(valleys);
  for (int i = 0; i < count; ++i) {
    const ExpandingFace& face = *valleys[static_cast<std::size_t>(i)];
    const std::uint64_t steps = face.distance >> 30;
    if (static_cast<Fine>(steps << shift) >= descent.best().depth) break;
    const Vec3<Unit> n = direction_of(-face.normal.x, -face.normal.y, -face.normal.z);
    if (lockstone::dot(n, descent.best().normal).raw < k_close << Unit::frac_bits) descent.from(n);
  }
}

/// Whether the polytope, which is inside the difference, leaves no room for a way out that is
/// shorter by more than 8 steps of the lattice.
bool proves(const ExpandingPolytope& polytope, int shift, Fine depth) {
  const auto steps = static_cast<Fine>(polytope.nearest().distance >> 30);
  return depth <= (steps + 8) << shift;
}

// Directions that the shapes single out
// ------------------------------------------------------------

/// The shortest of some ways out.
struct Shortest {
  Vec3<Unit> normal{};
  Fine depth = std::numeric_limits<Fine>::max();

  void take(const Vec3<Unit>& n, Fine along) {
    if (along >= depth) return;
    normal = n;
    depth = along;
  }
};

/// The directions of `for_each_face_direction`; `sign` turns them from A to B.
void take_faces(const ConvexCore& core, int sign, const Descent& descent, Shortest& shortest) {
  const auto take = [&](const Vec3<Unit>& outward) {
    const Vec3<Unit> n = signed_axis(outward, sign);
    shortest.take(n, descent.depth_along(n));
  };
  for_each_face_direction(core, take);
}

/// The directions that leave a side; `sign` turns them from A to B.
Ring ring_of(const Rims& side, int sign) {
  const RawVec axis = axis_of(side);
  const auto height = static_cast<Fine>(norm(axis.x, axis.y, axis.z));
  const Vec3<Unit> slope = direction_of(height, fine(side.radii[0]) - fine(side.radii[1]), 0);
  const Vec3<Unit> up = direction_of(axis.x, axis.y, axis.z);
  return {signed_axis(up, sign), slope.y, slope.x};
}

/// The descent from the shortest way out of a flat face.
void try_faces(const GapQuery& query, Descent& descent) {
  Shortest shortest;
  take_faces(query.a(), 1, descent, shortest);
  take_faces(query.b(), -1, descent, shortest);
  descent.try_from(shortest.normal);
}

/// The descents from the shortest ways across sides and across the edges of boxes and capsules.
void try_rings(const GapQuery& query, Descent& descent) {
  constexpr Fine k_tolerance = Fine{1} << (k_fine_bits - 21);  // half a micrometre
  const auto try_ring = [&](const Ring& ring) {
    descent.try_from(
        least_on_ring(query, descent.start(), ring, descent.best().depth, k_tolerance));
  };
  for (const bool first : {true, false}) {
    const ConvexCore& core = first ? query.a() : query.b();
    if (core.rims.count != 0) try_ring(ring_of(core.rims, first ? 1 : -1));
    for (int i = 0; i < core.generator_count; ++i) {
      const RawVec& g = core.generators[static_cast<std::size_t>(i)];
      try_ring({direction_of(g.x, g.y, g.z)});
    }
  }
}

}  // namespace

CoreOverlap rim_overlap(GapQuery& query, ExpandingPolytope& polytope) {
  constexpr int k_guide_vertices = 24;
  const LatticePair lattice = query.lattice();
  if (grow(lattice, polytope, k_guide_vertices) && polytope.holds_foot(polytope.nearest())) {
    CoreGap gap =
        refine(query.fine_pair(), lattice, polytope.simplex_of(polytope.nearest()), Side::before);
    gap.normal = -gap.normal;
    return {gap, true};
  }
  Descent descent(query);
  const auto is_proven = [&] { return proves(polytope, lattice.shift, descent.best().depth); };
  descend_from(polytope, lattice.shift, descent);
  if (!is_proven()) try_faces(query, descent);
  if (!is_proven()) try_rings(query, descent);
  descent.settle();
  query.return_to(descent.start());
  const WayOut& best = descent.best();
  return {{best.normal, std::max(Fine{0}, best.depth), best.on_a, best.on_b}, is_proven()};
}

}  // namespace lockstone::geometry
