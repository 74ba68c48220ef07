#include "core/geometry/distance/motion/time_of_impact.h"

#include <algorithm>
#include <limits>

namespace lockstone {
namespace geometry {
namespace {

constexpr Unit k_end = Unit::from_integer(1);

/// Above the error of a distance: see `distance`.
constexpr Fine k_search_error = Fine{1} << (k_fine_bits - 18);

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

/// The outward normal, in world axes, of that face of a box or of a polytope of few faces which a
/// point is farthest above; zero of other shapes. `point` is fine, from the shape's centre.
Vec3<Unit> facing_normal(const PosedShape& shape, const RawVec& point) {
  const RawVec local{dot(point, shape.rotation.x), dot(point, shape.rotation.y),
                     dot(point, shape.rotation.z)};
  Vec3<Unit> normal;
  Fine highest = std::numeric_limits<Fine>::min();
  if (shape.shape.kind == ShapeKind::box) {
    for (int i = 0; i < 3; ++i) {
      const Fine above = magnitude_of(local[i]) - fine(shape.shape.size[i]);
      if (above <= highest) continue;
      highest = above;
      normal = signed_axis(shape.rotation.column(i), sign_of(local[i]));
    }
  } else if (shape.polytope != nullptr && shape.polytope->wide == nullptr) {
    for (const PolytopeFace& face : shape.polytope->faces) {
      const Fine above = dot(local, face.normal) - face.offset;
      if (above <= highest) continue;
      highest = above;
      normal = face.normal;
    }
    normal = rotate(shape.rotation, normal);
  }
  return normal;
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
    const PosedShape posed_a{a_.shape, at_a.rotation, a_.polytope};
    const PosedShape posed_b{b_.shape, at_b.rotation, b_.polytope};
    GapQuery query(posed_a, posed_b);
    const Moment at{query, at_a, at_b, offset};
    if (result.iterations == 1 && stays_above_face(at, posed_a, posed_b)) {
      result.fraction = k_end;
      return false;
    }
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
    return step(at, result);
  }

  /// A moment on the way.
  struct Moment {
    const GapQuery& query;
    const Placement& a;
    const Placement& b;
    const RawVec& offset;  ///< from A's shape centre to B's
  };

  /// The cores as they move on, and a plane that is to keep them apart by their radii and `beyond`.
  [[nodiscard]] SeparatedPair pair_at(const Moment& at, const Vec3<Unit>& normal,
                                      Fine beyond) const {
    return {{at.query.a(), a_.sweep, -at.a.lever, {}},
            {at.query.b(), b_.sweep, at.offset - at.b.lever, at.offset},
            normal,
            to_metres(at.query.radii() + beyond)};
  }

  /// Whether a face of the greater body alone shows that the other never comes as near as the
  /// limits ask, as of most bodies that are carried along: for a third of the cost of a step.
  [[nodiscard]] bool stays_above_face(const Moment& at, const PosedShape& a, const PosedShape& b) {
    const auto size = [](const RawVec& extent) { return extent.x + extent.y + extent.z; };
    const bool of_a = size(at.query.a().extent) >= size(at.query.b().extent);
    const Vec3<Unit> outward = of_a ? facing_normal(a, at.offset) : facing_normal(b, -at.offset);
    if (outward == Vec3<Unit>{}) return false;
    const Fine limit = fine(limits_.target) + fine(limits_.tolerance) + k_search_error;
    const SeparatedPair pair = pair_at(at, of_a ? outward : -outward, limit);
    return stays_parted(pair, of_a ? pair.a : pair.b, scratch_);
  }

  bool step(const Moment& at, TimeOfImpact& result) {
    const SeparatedPair pair = pair_at(at, at.query.gap().normal, fine(limits_.target));
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
