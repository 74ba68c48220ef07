#include "core/geometry/distance/motion/time_of_impact.h"

#include <algorithm>

namespace lockstone {
namespace geometry {
namespace {

constexpr Unit k_end = Unit::from_integer(1);

RawVec fine_difference(const Vec3<Position>& to, const Vec3<Position>& from) {
  const auto lane = [](Position x, Position y) {
    const std::int64_t difference = raw::subtract(x.raw, y.raw);
    LKS_ASSERT(magnitude(difference) < std::uint64_t{1} << (k_metre_bits + 12));
    return difference * (std::int64_t{1} << k_fine_per_metre);
  };
  return {lane(to.x, from.x), lane(to.y, from.y), lane(to.z, from.z)};
}

/// A swept shape at one moment.
struct Placement {
  Mat3 rotation;
  Vec3<Position> centre;  ///< of the shape
  RawVec lever;           ///< to there from the centre of rotation, fine
};

Placement place(const SweptShape& shape, Unit fraction) {
  const Transform pose = pose_at(shape.sweep, fraction);
  const Vec3<Position> centre = apply(pose, shape.origin);
  return {to_matrix(pose.orientation), centre, fine_difference(centre, pose.position)};
}

class Advancement {
 public:
  Advancement(const SweptShape& a, const SweptShape& b, const TimeOfImpactLimits& limits)
      : a_(a), b_(b), limits_(limits) {}

  [[nodiscard]] TimeOfImpact run() {
    TimeOfImpact result;
    while (result.iterations < limits_.max_iterations) {
      ++result.iterations;
      if (!advance(result)) return result;
    }
    result.state = TimeOfImpactState::unfinished;
    return result;
  }

 private:
  /// One step from result.fraction; false when the answer is there.
  bool advance(TimeOfImpact& result) {
    const Placement at_a = place(a_, result.fraction);
    const Placement at_b = place(b_, result.fraction);
    const RawVec offset = fine_difference(at_b.centre, at_a.centre);
    GapQuery query({a_.shape, at_a.rotation, a_.polytope}, {b_.shape, at_b.rotation, b_.polytope});
    const bool apart = query.find(offset);
    const Fine distance = apart ? query.gap().distance - query.radii() : 0;
    if (distance <= 0 && result.fraction.raw > 0) {
      // Beyond the documented bounds; the step before is still on the safe side.
      result.fraction = previous_;
      result.state = TimeOfImpactState::hit;
      return false;
    }
    result.normal = apart ? query.gap().normal : Vec3<Unit>{};
    result.distance = Position::from_raw(std::max(Fine{0}, to_metres(distance)));
    if (distance <= 0) {
      result.state = TimeOfImpactState::overlapping;
      return false;
    }
    if (distance <= fine(limits_.target) + fine(limits_.tolerance)) {
      result.state = TimeOfImpactState::hit;
      return false;
    }
    return step(query, at_a, at_b, result);
  }

  bool step(const GapQuery& query, const Placement& at_a, const Placement& at_b,
            TimeOfImpact& result) {
    const RawVec offset = query.fine_pair().offset;
    const SeparatedPair pair{{query.a(), a_.sweep, -at_a.lever, {}},
                             {query.b(), b_.sweep, offset - at_b.lever, offset},
                             query.gap().normal,
                             to_metres(query.radii() + fine(limits_.target))};
    const Unit rest = k_end - result.fraction;
    const Unit step = safe_step(pair, rest, scratch_);
    previous_ = result.fraction;
    result.fraction += step;
    if (step == rest) {
      result.state = TimeOfImpactState::separated;
      result.normal = {};
      return false;
    }
    // No step that a fraction can express: as near as it gets.
    result.state = TimeOfImpactState::unfinished;
    return step.raw > 0;
  }

  const SweptShape& a_;
  const SweptShape& b_;
  const TimeOfImpactLimits& limits_;
  Unit previous_{};
  Projections scratch_;
};

}  // namespace
}  // namespace geometry

Transform pose_at(const Sweep& sweep, Unit fraction) {
  RotationVector turned;
  Vec3<Position> moved;
  for (int i = 0; i < 3; ++i) {
    turned[i].raw = geometry::part(sweep.rotation[i].raw, fraction);
    moved[i].raw = geometry::part(sweep.translation[i].raw, fraction);
  }
  return {sweep.start.position + moved, integrate(sweep.start.orientation, turned)};
}

Transform carried(const Transform& pose, const Sweep& by) {
  return compose(pose_at(by, Unit::from_integer(1)), compose(inverse(by.start), pose));
}

TimeOfImpact time_of_impact(const SweptShape& a, const SweptShape& b,
                            const TimeOfImpactLimits& limits) {
  using namespace geometry;
  const Placement at_a = place(a, {});
  const Placement at_b = place(b, {});
  const bool exchange =
      is_exchanged({a.shape, at_a.rotation, a.polytope}, {b.shape, at_b.rotation, b.polytope},
                   fine_difference(at_b.centre, at_a.centre));
  if (!exchange) return Advancement(a, b, limits).run();
  TimeOfImpact result = Advancement(b, a, limits).run();
  result.normal = -result.normal;
  return result;
}

}  // namespace lockstone
