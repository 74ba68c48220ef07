#include "core/geometry/distance/epa/rim_overlap.h"

#include <limits>

#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_guide_vertices = 40;
constexpr int k_max_valleys = 12;
constexpr int k_max_rounds = 12;

/// A way out along `normal`.
struct WayOut {
  Vec3<Unit> normal{};
  Fine depth = std::numeric_limits<Fine>::max();
  RawVec on_a{};
};

RawVec raws_of(const Vec3<Unit>& n) {
  return {n.x.raw, n.y.raw, n.z.raw};
}

/// Whether two unit vectors differ by less than 2^-20 in each component.
bool is_alike(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  constexpr std::int64_t k_alike = std::int64_t{1} << 10;
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
        clearance_(Fine{1} << (query.lattice().shift + 20)) {}

  void from(Vec3<Unit> n) {
    WayOut here = next_of(n);
    for (int round = 0; round < k_max_rounds && here.depth != k_none; ++round) {
      const WayOut next = next_of(here.normal);
      if (next.depth == k_none || is_alike(next.normal, here.normal)) return;
      const Vec3<Unit> limit = limit_of(n, here.normal, next.normal);
      n = next.normal;
      here = next_of(n);
      const WayOut leap = next_of(limit);
      if (leap.depth > here.depth) continue;
      n = limit;
      here = leap;
    }
  }

  [[nodiscard]] const WayOut& best() const { return best_; }
  [[nodiscard]] const RawVec& start() const { return start_; }

 private:
  static constexpr Fine k_none = std::numeric_limits<Fine>::max();

  /// The depth along n, as the vertices of the lattice give it.
  Fine depth_along(const Vec3<Unit>& n) const {
    const DifferenceVertex least = least_along(query_.lattice(), raws_of(n));
    return dot(vertex_of(query_.a(), least.a) - vertex_of(query_.b(), least.b) - start_, n);
  }

  /// The way out that the closest points show when B has just left along n.
  WayOut next_of(const Vec3<Unit>& n) {
    const RawVec shift = along(n, depth_along(n) + clearance_);
    if (!query_.find(start_ + shift)) return {};
    const CoreGap& gap = query_.gap();
    const WayOut way{gap.normal, dot(shift, gap.normal) - gap.distance, gap.on_a};
    if (way.depth < best_.depth) best_ = way;
    return way;
  }

  GapQuery& query_;
  RawVec start_;
  Fine clearance_;  ///< 2^-10 of the greatest distance of points
  WayOut best_{};
};

/// Grows the polytope to the guide's size; true when its nearest face supports the difference.
bool grow(const LatticePair& lattice, ExpandingPolytope& polytope) {
  constexpr std::int64_t k_steps_left = 8;
  while (polytope.vertex_count() < k_guide_vertices) {
    const ExpandingFace& nearest = polytope.nearest();
    const DifferenceVertex vertex = greatest_along(lattice, nearest.normal);
    if (!polytope.sees_from_afar(vertex.point, nearest, k_steps_left)) return true;
    polytope.expand(vertex);
  }
  return false;
}

}  // namespace

CoreOverlap rim_overlap(GapQuery& query, ExpandingPolytope& polytope) {
  const bool supported = grow(query.lattice(), polytope);
  const int shift = query.lattice().shift;
  Descent descent(query);
  std::array<const ExpandingFace*, k_max_valleys> valleys;
  const int count = polytope.find_valleys(valleys);
  for (int i = 0; i < count; ++i) {
    const ExpandingFace& face = *valleys[static_cast<std::size_t>(i)];
    const std::uint64_t steps = face.distance >> 30;
    if (static_cast<Fine>(steps << shift) >= descent.best().depth) break;
    const RawVec n = -face.normal;
    descent.from(direction_of(n.x, n.y, n.z));
  }
  query.return_to(descent.start());
  const WayOut& best = descent.best();
  const Fine depth = std::max(Fine{0}, best.depth);
  const RawVec on_b = best.on_a - along(best.normal, depth);
  return {{best.normal, depth, best.on_a, on_b}, supported};
}

}  // namespace lockstone::geometry
