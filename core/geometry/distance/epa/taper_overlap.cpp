#include "core/geometry/distance/epa/taper_overlap.h"

#include <algorithm>
#include <limits>

#include "core/geometry/distance/cores/rim_point_gap.h"
#include "core/geometry/distance/cores/taper_point_gap.h"
#include "core/geometry/distance/epa/face_directions.h"
#include "core/geometry/distance/epa/ring_search.h"
#include "core/geometry/numeric/segment.h"

namespace lockstone::geometry {
namespace {

constexpr Fine k_any_depth = std::numeric_limits<Fine>::max();

/// The directions that leave the side of a tapered core; `sign` turns them from A to B.
Ring ring_of(const ConvexCore& taper, int sign) {
  const RawVec axis = vertex_of(taper, 1) - vertex_of(taper, 0);
  const auto length = static_cast<std::int64_t>(norm(axis.x, axis.y, axis.z));
  const Fine fall = taper.swell[0] - taper.swell[1];
  const Vec3<Unit> slope = direction_of(taper_rise(length, fall), fall, 0);
  const Vec3<Unit> up = direction_of(axis.x, axis.y, axis.z);
  return {signed_axis(up, sign), slope.y, slope.x};
}

class WaysOut {
 public:
  explicit WaysOut(GapQuery& query) : query_(query), pair_(query.fine_pair()) {}

  void take(const Vec3<Unit>& n) {
    const Fine depth = dot(deepest_a(n) - deepest_b(n), n);
    if (depth >= depth_) return;
    depth_ = depth;
    normal_ = n;
  }

  /// The ways out through faces, sides and the taper's own side; `sign` is 1 where it is A.
  void take_all(const ConvexCore& taper, const ConvexCore& other, int sign) {
    for_each_face_direction(taper, [&](const Vec3<Unit>& n) { take(n); });
    for_each_face_direction(other, [&](const Vec3<Unit>& n) { take(signed_axis(n, -sign)); });
    for (const int end : {0, 1})
      take_nearest(vertex_of(taper, end), other, sign);
    constexpr Fine k_tolerance = Fine{1} << (k_fine_bits - 21);  // half a micrometre
    take(least_on_ring(query_, pair_.offset, ring_of(taper, sign), k_any_depth, k_tolerance));
  }

  void refine() {
    constexpr int k_rounds = 3;
    const RawVec offset = pair_.offset;
    for (int round = 0; round < k_rounds; ++round) {
      const Fine before = depth_;
      if (!query_.find(offset + way_apart())) break;
      take(query_.gap().normal);
      if (depth_ == before) break;
    }
    query_.return_to(offset);
  }

  [[nodiscard]] CoreOverlap best() const {
    CoreGap gap{normal_, depth_, deepest_a(normal_), deepest_b(normal_)};
    const RawVec apart = along(normal_, gap.distance);
    if (do_sides_cross()) {
      gap.on_a = on_crossing();
      gap.on_b = gap.on_a - apart;
      return {gap, true};
    }
    // A corner or a ball stays, the other point moves within its face or side.
    const bool keep_a =
        is_tapered(pair_.a) ? !is_side_of(pair_.a, normal_) : is_side_of(pair_.b, -normal_);
    (keep_a ? gap.on_b : gap.on_a) = keep_a ? gap.on_a - apart : gap.on_b + apart;
    if (!is_on_side(keep_a, gap)) meet_side(keep_a, gap);
    return {gap, pair_.a.rims.count == 0 && pair_.b.rims.count == 0};
  }

 private:
  /// Whether each is deepest along a line of its side.
  [[nodiscard]] bool do_sides_cross() const {
    return is_axis(pair_.a) && is_axis(pair_.b) && is_side_of(pair_.a, normal_) &&
           is_side_of(pair_.b, -normal_);
  }

  /// By which the shapes are drawn apart.
  [[nodiscard]] RawVec way_apart() const {
    return along(normal_, depth_ + (Fine{1} << (query_.lattice().shift + 20)));
  }

  /// Whether the point that moved is on the taper, if that is where it moved.
  [[nodiscard]] bool is_on_side(bool keeps_a, const CoreGap& gap) const {
    constexpr Fine k_beside = Fine{1} << (k_fine_bits - 14);  // 61 µm
    const ConvexCore& moved = keeps_a ? pair_.b : pair_.a;
    if (!is_tapered(moved)) return true;
    const RawVec point = keeps_a ? gap.on_b - pair_.offset : gap.on_a;
    return magnitude_of(taper_point_gap(moved, point).gap.distance) <= k_beside;
  }

  /// Where the other's feature is an edge or a face, the corner of it that was found need not be at
  /// the taper's line. The points are those that are nearest once the two are drawn apart.
  void meet_side(bool is_b, CoreGap& gap) const {
    const RawVec apart = along(normal_, gap.distance);
    const RawVec way = way_apart();
    if (query_.find(pair_.offset + way)) {
      const CoreGap& drawn = query_.gap();
      gap.on_a = is_b ? drawn.on_b - way + apart : drawn.on_a;
      gap.on_b = gap.on_a - apart;
    }
    query_.return_to(pair_.offset);
  }

  static bool is_axis(const ConvexCore& core) {
    return is_taper(core) && core.generator_count == 1;
  }

  /// Of A's side, over the point of its axis that B's axis crosses.
  [[nodiscard]] RawVec on_crossing() const {
    const auto segment_of = [](const ConvexCore& core, const RawVec& at) {
      const RawVec& g = core.generators[0];
      const Direction d = direction(g.x, g.y, g.z);
      return Segment{core.reference + at, d.unit,
                     Length::from_raw(static_cast<std::int32_t>(d.length >> k_fine_per_length))};
    };
    const Segment a = segment_of(pair_.a, {}), b = segment_of(pair_.b, pair_.offset);
    const RawVec point = point_at(a, closest_parameters(a, b).on_a);
    const RawVec side = deepest_a(normal_) - point;
    return point + along(normal_, dot(side, normal_));
  }

  [[nodiscard]] RawVec deepest_a(const Vec3<Unit>& n) const { return farthest_point(pair_.a, n); }
  [[nodiscard]] RawVec deepest_b(const Vec3<Unit>& n) const {
    return pair_.offset + farthest_point(pair_.b, -n);
  }

  /// The way to the other's surface where it is nearest to a ball's centre: within it to the side
  /// of a solid of revolution, outside it to the nearest point.
  void take_nearest(const RawVec& centre, const ConvexCore& other, int sign) {
    const RawVec point = centre - (sign > 0 ? pair_.offset : -pair_.offset);
    if (is_taper(other)) return take(signed_axis(taper_point_gap(other, point).gap.normal, -sign));
    if (other.rims.count != 0) take(signed_axis(rim_side_normal(other.rims, point), -sign));
    GapQuery from_point(ConvexCore{}, other);
    if (from_point.find(-point)) take(signed_axis(from_point.gap().normal, sign));
  }

  /// Whether both balls reach equally far along n.
  static bool is_side_of(const ConvexCore& taper, const Vec3<Unit>& n) {
    const Fine low = dot(vertex_of(taper, 0), n) + taper.swell[0];
    const Fine high = dot(vertex_of(taper, 1), n) + taper.swell[1];
    return magnitude_of(high - low) < k_no_distance;
  }

  GapQuery& query_;
  FinePair pair_;
  Vec3<Unit> normal_ = k_concentric_normal;
  Fine depth_ = k_any_depth;
};

}  // namespace

CoreOverlap taper_overlap(GapQuery& query) {
  WaysOut ways(query);
  if (is_tapered(query.a())) ways.take_all(query.a(), query.b(), 1);
  if (is_tapered(query.b())) ways.take_all(query.b(), query.a(), -1);
  ways.refine();
  return ways.best();
}

}  // namespace lockstone::geometry
