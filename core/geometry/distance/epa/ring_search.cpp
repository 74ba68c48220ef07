#include "core/geometry/distance/epa/ring_search.h"

#include <algorithm>
#include <limits>

#include <lockstone/trigonometry.h>

#include "core/geometry/distance/cores/rims.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_first_angles = 16;
constexpr int k_most_angles = 160;
constexpr auto k_ring_end = static_cast<std::int32_t>(k_full_turn);

/// The depth along one direction of the ring, and how it changes with the angle.
struct Place {
  std::int32_t angle;  ///< 27 fraction bits, 0 … k_ring_end
  Fine depth;
  Fine slope;
  Fine curvature;
  Fine unsure;  ///< by how much the curvature may change in a radian

  /// How deep it is at least, `by` further on.
  [[nodiscard]] Fine bound(std::int32_t by) const {
    const SinCos turn = sin_cos(Angle::from_raw(by));
    const std::int64_t square = std::int64_t{by} * by >> Angle::frac_bits;
    const std::int64_t cube = magnitude_of(by) * square >> (2 * Angle::frac_bits - Unit::frac_bits);
    return depth + scaled(slope, turn.sin.raw) +
           scaled(curvature, Unit::from_integer(1).raw - turn.cos.raw) -
           scaled(unsure, static_cast<std::int32_t>(cube));
  }
};

/// The point of a core that is farthest along a direction, the radius of the rim it is on, and that
/// of the ball around it.
struct Farthest {
  RawVec point{};
  Fine radius = 0;
  Fine swell = 0;
};

Farthest farther_ball(const ConvexCore& core, const Vec3<Unit>& n) {
  const RawVec first = vertex_of(core, 0), second = vertex_of(core, 1);
  const bool is_second = dot(second - first, n) + core.swell[1] - core.swell[0] > 0;
  return is_second ? Farthest{second, 0, core.swell[1]} : Farthest{first, 0, core.swell[0]};
}

/// `vertex` is the farthest. On a rim the circle's point stands in for it, because a step of the
/// polygon changes slopes by 1e-4 of the radius; and of a cone that is as far along its side, the
/// rim for the apex: its curvature bounds the depth more closely.
Farthest farthest_of(const ConvexCore& core, int vertex, const Vec3<Unit>& n) {
  constexpr Fine k_as_far = Fine{1} << (k_fine_bits - 20);
  if (is_tapered(core)) return farther_ball(core, n);
  if (core.rims.count == 0) return {vertex_of(core, vertex)};
  const auto on_rim = [&](int rim) {
    const Fine radius = fine(core.rims.radii[static_cast<std::size_t>(rim)]);
    return Farthest{rim_point(core.rims, rim, rim_angle(core.rims, raws_of(n)), radius), radius};
  };
  const Farthest first = on_rim(vertex >> k_rim_bits);
  if (first.radius != 0) return first;
  const Farthest base = on_rim(0);
  return dot(first.point - base.point, n) < k_as_far ? base : first;
}

Vec3<Unit> unit_axis_of(const Rims& rims) {
  return rounded<Unit>(lockstone::cross(rims.u, rims.v));
}

/// The part of the ring from one place to the next.
struct Gap {
  std::int32_t best;  ///< from the first of both, where the bound is least
  Fine bound;
};

/// Where the bound of the first place falls to that of the second, by halves and by secants in
/// turns.
Gap crossing_of(const Place& from, const Place& to, std::int32_t length) {
  constexpr Fine k_enough = Fine{1} << (k_fine_bits - 23);  // 0.1 µm
  std::int32_t low = 0, high = length;
  Fine above = from.depth - to.bound(-length), below = from.bound(length) - to.depth;
  Gap gap{length, to.depth};
  for (int i = 0; i < 24 && high - low > 1; ++i) {
    std::int32_t middle = low + (high - low) / 2;
    if (i % 2 != 0 && above > 0 && below < 0)
      middle = low + static_cast<std::int32_t>(
                         round_divide(multiply_wide(above, high - low), above - below));
    const Fine first = from.bound(middle), second = to.bound(middle - length);
    gap = {middle, std::max(first, second)};
    if (magnitude_of(first - second) < k_enough) break;
    (first > second ? low : high) = middle;
    (first > second ? above : below) = first - second;
  }
  return gap;
}

Gap gap_between(const Place& from, const Place& to, std::int32_t length) {
  const auto bound = [&](std::int32_t at) {
    return std::max(from.bound(at), to.bound(at - length));
  };
  Gap gap = crossing_of(from, to, length);
  // A bound that is curved upwards may be least before that.
  for (const bool first : {true, false}) {
    const Place& place = first ? from : to;
    const Fine fall = first ? -place.slope : place.slope;
    if (fall <= 0 || place.curvature <= 0) continue;
    const std::int32_t step = atan2_raw(fall, place.curvature).raw;
    if (step >= length) continue;
    const std::int32_t at = first ? step : length - step;
    if (bound(at) < gap.bound) gap = {at, bound(at)};
  }
  return gap;
}

class RingSearch {
 public:
  RingSearch(const GapQuery& query, const RawVec& offset, const Ring& ring)
      : query_(query), offset_(offset), ring_(ring), u_(perpendicular_to(ring.axis)) {
    v_ = rounded<Unit>(lockstone::cross(ring.axis, u_));
    unsure_ = change_of(query.a()) + change_of(query.b());
  }

  Vec3<Unit> least(Fine most, Fine tolerance) {
    for (; count_ < k_first_angles; ++count_) {
      at(count_).place = place_at(k_ring_end / k_first_angles * count_);
      at(count_).next = (count_ + 1) % k_first_angles;
    }
    for (int i = 0; i < k_first_angles; ++i)
      measure(i);
    for (; count_ < k_most_angles; ++count_) {
      const int least = least_gap();
      if (at(least).gap.bound >= std::min(most, best_.depth) - tolerance) break;
      at(count_) = {place_at(at(least).place.angle + at(least).gap.best), {}, at(least).next};
      at(least).next = count_;
      measure(least);
      measure(count_);
    }
    return direction_at(best_.angle);
  }

 private:
  struct Frame {
    Vec3<Unit> normal;
    Vec3<Unit> tangent;
  };

  [[nodiscard]] Frame frame_at(std::int32_t angle) const {
    const SinCos turn = sin_cos(Angle::from_raw(angle));
    const auto lane = [&](Unit u, Unit v, Unit axis) {
      return ring_.flat * rounded<Unit>(u * turn.cos + v * turn.sin) + axis * ring_.rise;
    };
    const auto aside = [&](Unit u, Unit v) { return rounded<Unit>(v * turn.cos - u * turn.sin); };
    return {{rounded<Unit>(lane(u_.x, v_.x, ring_.axis.x)),
             rounded<Unit>(lane(u_.y, v_.y, ring_.axis.y)),
             rounded<Unit>(lane(u_.z, v_.z, ring_.axis.z))},
            {aside(u_.x, v_.x), aside(u_.y, v_.y), aside(u_.z, v_.z)}};
  }

  [[nodiscard]] Vec3<Unit> direction_at(std::int32_t angle) const {
    const Vec3<Unit> n = frame_at(angle).normal;
    return direction_of(n.x.raw, n.y.raw, n.z.raw);
  }

  Place place_at(std::int32_t angle) {
    const auto [n, tangent] = frame_at(angle);
    const DifferenceVertex least = least_along(query_.lattice(), raws_of(n));
    const Farthest a = farthest_of(query_.a(), least.a, n);
    const Farthest b = farthest_of(query_.b(), least.b, -n);
    const RawVec w = a.point - b.point - offset_;
    const Fine core_depth = dot(w, n);
    Place place{angle, core_depth + a.swell + b.swell, scaled(dot(w, tangent), ring_.flat.raw), 0,
                unsure_};
    place.curvature = scaled(dot(w, ring_.axis), ring_.rise.raw) - core_depth +
                      of_rim(query_.a(), a.radius, n, tangent) +
                      of_rim(query_.b(), b.radius, n, tangent);
    if (place.depth < best_.depth) best_ = place;
    return place;
  }

  /// How much a core's curvature may change along the ring: none about the axis of its rims.
  [[nodiscard]] Fine change_of(const ConvexCore& core) const {
    if (core.rims.count == 0) return 0;
    const RawVec across =
        raws_of(rounded<Unit>(lockstone::cross(unit_axis_of(core.rims), ring_.axis)));
    const auto sine = static_cast<std::int32_t>(norm(across.x, across.y, across.z));
    return scaled(fine(core.rims.radii[0]), sine);
  }

  /// How much a rim's point that follows the direction adds to the curvature: radius · (the part of
  /// the direction's change along the rim)² / |the direction across the rim's axis|.
  [[nodiscard]] Fine of_rim(const ConvexCore& core, Fine radius, const Vec3<Unit>& n,
                            const Vec3<Unit>& tangent) const {
    if (radius == 0) return 0;
    const Vec3<Unit> along_rim = rounded<Unit>(lockstone::cross(unit_axis_of(core.rims), n));
    const RawVec r = raws_of(along_rim);
    const auto across = static_cast<std::int64_t>(norm(r.x, r.y, r.z));
    if (across < std::int64_t{1} << 15) return 0;
    const Unit part = rounded<Unit>(ring_.flat * rounded<Unit>(lockstone::dot(tangent, along_rim)));
    const Fine once = round_divide(multiply_wide(radius, part.raw), across);
    const Fine twice = round_divide(multiply_wide(once, part.raw), across);
    return scaled(twice, static_cast<std::int32_t>(across));
  }

  /// A place that was looked at, the one that follows on the ring, and the gap between.
  struct Looked {
    Place place;
    Gap gap;
    int next;
  };

  Looked& at(int i) { return looked_[static_cast<std::size_t>(i)]; }

  int least_gap() {
    int least = 0;
    for (int i = 1; i < count_; ++i)
      if (at(i).gap.bound < at(least).gap.bound) least = i;
    return least;
  }

  void measure(int i) {
    const Place &from = at(i).place, &to = at(at(i).next).place;
    const std::int32_t end = to.angle != 0 ? to.angle : k_ring_end;
    at(i).gap = gap_between(from, to, end - from.angle);
  }

  const GapQuery& query_;
  RawVec offset_;
  Ring ring_;
  Vec3<Unit> u_;
  Vec3<Unit> v_{};
  Fine unsure_ = 0;
  int count_ = 0;
  std::array<Looked, k_most_angles> looked_;  // left unset beyond count_
  Place best_{0, std::numeric_limits<Fine>::max(), 0, 0, 0};
};

}  // namespace

Vec3<Unit> least_on_ring(const GapQuery& query, const RawVec& offset, const Ring& ring, Fine most,
                         Fine tolerance) {
  return RingSearch(query, offset, ring).least(most, tolerance);
}

}  // namespace lockstone::geometry
