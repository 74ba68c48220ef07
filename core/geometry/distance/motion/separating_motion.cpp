#include "core/geometry/distance/motion/separating_motion.h"

#include <algorithm>
#include <limits>

#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// The rounding error in one dimension: 4 nm.
constexpr Metres k_rounding = 16;
/// Bounds above this are as good as infinite.
constexpr Metres k_bound = Metres{1} << 54;

/// The motion of the plane: with a body, or none.
struct PlaneFrame {
  const MovingCore* body = nullptr;
};

/// n × v in the format of v, |v| < 2^14 units of 32 fraction bits.
RawVec turned(const Vec3<Unit>& n, const RawVec& v) {
  return {part(v.z, n.y) - part(v.y, n.z), part(v.x, n.z) - part(v.z, n.x),
          part(v.y, n.x) - part(v.x, n.y)};
}

Metres along_normal(const Vec3<Unit>& n, const RawVec& v) {
  return part(v.x, n.x) + part(v.y, n.y) + part(v.z, n.z);
}

/// The norm, rounded up, or 0.
Metres norm_above(const RawVec& v) {
  return v == RawVec{} ? 0 : static_cast<Metres>(norm(v.x, v.y, v.z)) + 1;
}

/// Above the square of a fine vector's norm, 36 fraction bits; 0 of the zero vector.
std::uint64_t square_above(const RawVec& v) {
  if (v == RawVec{}) return 0;
  const auto square = [](Fine x) {
    const std::uint64_t steps = (magnitude(x) >> 32) + 1;
    return steps * steps;
  };
  return square(v.x) + square(v.y) + square(v.z);
}

/// The root of such a square, rounded up.
Metres root_above(std::uint64_t square) {
  if (square == 0) return 0;
  return (Metres{isqrt(square)} + 1) * (Metres{1} << (k_metre_bits - 18));
}

Metres sum_above(Metres a, Metres b) {
  return std::min(k_bound, a + b);
}

/// a · b with 32 fraction bits each, rounded up, at most k_bound; both in [0, k_bound].
Metres product_above(Metres a, Metres b) {
  if (a == 0 || b == 0) return 0;
  const Int128 product = (multiply_wide(a, b) >> k_metre_bits) + Int128::from(1);
  return product > Int128::from(k_bound) ? k_bound : static_cast<Metres>(product.low);
}

/// The speed along n of a point at a fine lever, `axis` = n × ω: (ω × r) · n = r · (n × ω).
Metres turning_speed(const RawVec& axis, const RawVec& lever) {
  if (axis == RawVec{}) return 0;
  return static_cast<Metres>(round_shift(wide_dot(axis, lever), k_fine_bits).low);
}

/// Bounds over all vertices.
struct Reach {
  Metres from_centre = 0;  ///< of rotation
  Metres from_frame = 0;   ///< the frame's centre
};

/// x = q − p in a frame that turns with Ω about p, n turning with it:
/// (n·x)¨ = n̈·x + 2ṅ·ẋ + n·ẍ ≤ |Ω|²·|x| + 2|Ω|·|ẋ| + |ω|²·r, and |ẋ| ≤ |v| + |ω|·r.
Metres acceleration_in(const MovingCore& body, const PlaneFrame& frame, const Vec3<Unit>& normal,
                       Reach reach) {
  const RawVec turning = raws_of(body.sweep.rotation);
  const Metres spin = norm_above(turning);
  if (frame.body == nullptr) {
    const Metres across = norm_above(turned(normal, turning));
    return product_above(product_above(across, spin), reach.from_centre);
  }
  const RawVec translation =
      raws_of(body.sweep.translation) - raws_of(frame.body->sweep.translation);
  const Metres frame_spin = norm_above(raws_of(frame.body->sweep.rotation));
  const Metres surface = product_above(spin, reach.from_centre);
  const Metres speed = sum_above(norm_above(translation), surface);
  const Metres distance = sum_above(reach.from_frame, speed);  // until the end of the sweep
  return sum_above(product_above(product_above(frame_spin, frame_spin), distance),
                   sum_above(product_above(2 * frame_spin, speed), product_above(spin, surface)));
}

/// Calls `f` with the vertices of the core and their swell, or of a polytope around it that reaches
/// as far along the normal.
template <class F>
void for_each_bound(const ConvexCore& core, const Vec3<Unit>& normal, F&& f) {
  const int count = core.rims.count != 0 ? 0 : vertex_count(core);
  for (int i = 0; i < count; ++i)
    f(vertex_of(core, i), swell_at(core, i));
  if (core.rims.count == 0) return;
  const Angle angle = rim_angle(core.rims, raws_of(normal));
  for (int rim = 0; rim < core.rims.count; ++rim) {
    const bool is_point = core.rims.radii[static_cast<std::size_t>(rim)] == Length{};
    const int sides = is_point ? 1 : k_rim_sides;
    for (int side = 0; side < sides; ++side)
      f(around_rim(core.rims, rim, angle, side), Fine{0});
  }
}

/// Of the body that the plane turns with: no vertex moves.
void project_still(const MovingCore& body, const Vec3<Unit>& normal, Projection& projection) {
  Fine greatest = std::numeric_limits<Fine>::min();
  for_each_bound(body.core, normal, [&](const RawVec& point, Fine swell) {
    greatest = std::max(greatest, dot(point + body.shape, normal) + swell);
  });
  projection.count = 1;
  projection.lines[0] = {to_metres(greatest), 0};
  projection.rate = projection.turning_rate = projection.acceleration = 0;
}

void project(const MovingCore& body, const PlaneFrame& frame, const Vec3<Unit>& normal,
             Projection& projection) {
  if (frame.body == &body) return project_still(body, normal, projection);
  const ConvexCore& core = body.core;
  const RawVec axis = turned(normal, raws_of(body.sweep.rotation));
  RawVec frame_axis;
  RawVec frame_centre;
  RawVec translation = raws_of(body.sweep.translation);
  if (frame.body != nullptr) {
    frame_axis = turned(normal, raws_of(frame.body->sweep.rotation));
    frame_centre = frame.body->centre;
    translation = translation - raws_of(frame.body->sweep.translation);
  }
  projection.count = 0;
  projection.rate = along_normal(normal, translation);
  std::uint64_t from_centre = 0;
  std::uint64_t from_plane = 0;
  for_each_bound(core, normal, [&](const RawVec& point, Fine swell) {
    const RawVec vertex = point + body.shape;
    const RawVec lever = vertex - body.centre;
    const RawVec from_frame = vertex - frame_centre;
    projection.lines[static_cast<std::size_t>(projection.count++)] = {
        to_metres(dot(vertex, normal) + swell),
        projection.rate + turning_speed(axis, lever) - turning_speed(frame_axis, from_frame)};
    from_centre = std::max(from_centre, square_above(lever));
    from_plane = std::max(from_plane, square_above(from_frame));
  });
  const Reach reach{root_above(from_centre), root_above(from_plane)};
  projection.turning_rate = product_above(norm_above(axis), reach.from_centre);
  projection.acceleration = acceleration_in(body, frame, normal, reach);
}

void project(const SeparatedPair& pair, const PlaneFrame& frame, Projections& projections) {
  project(pair.a, frame, pair.normal, projections.a);
  project(pair.b, frame, -pair.normal, projections.b);
}

/// A lower bound of the distance above the reserve after a step.
Metres excess_after(const Projections& p, Metres reserve, Unit step) {
  const Metres bend = part(part(sum_above(p.a.acceleration, p.b.acceleration), step), step) / 2;
  return -p.b.greatest(step) - p.a.greatest(step) - reserve - bend - k_rounding;
}

/// The step that the greatest speed allows; in a frame at rest.
Unit step_by_speed(const Projections& p, Metres reserve, Unit rest) {
  const Metres speed =
      p.a.rate + p.b.rate + sum_above(p.a.turning_rate, p.b.turning_rate) + k_rounding;
  if (speed <= 0) return rest;
  const Metres room = std::max(Metres{0}, excess_after(p, reserve, {}));
  if (room >= speed) return rest;
  const UInt128 numerator = UInt128{0, static_cast<std::uint64_t>(room)} << Unit::frac_bits;
  const auto step = divide(numerator, static_cast<std::uint64_t>(speed)).quotient;
  return min(rest, Unit::from_raw(static_cast<std::int32_t>(step)));
}

/// A step from `low` up to `high` by each vertex' own speed. The bound is concave, so the root of
/// a chord and every point where the bound is not negative are on the safe side.
Unit step_by_vertices(const Projections& p, Metres reserve, Unit low, Unit high) {
  constexpr int iterations = 12;
  Metres at_low = excess_after(p, reserve, low);
  if (at_low < 0) return low;
  Metres at_high = excess_after(p, reserve, high);
  if (at_high >= 0) return high;
  for (int i = 0; i < iterations; ++i) {
    const std::int64_t width = std::int64_t{high.raw} - low.raw;
    const UInt128 product = multiply_wide(magnitude(at_low), magnitude(width));
    const std::uint64_t fall = magnitude(at_low) + magnitude(at_high);
    const auto chord = static_cast<std::int64_t>(divide(product, fall).quotient);
    const std::int64_t ahead = i % 2 == 0 ? chord : width / 2;
    if (ahead == 0) continue;
    const Unit middle = Unit::from_raw(static_cast<std::int32_t>(low.raw + ahead));
    const Metres at_middle = excess_after(p, reserve, middle);
    (at_middle < 0 ? high : low) = middle;
    (at_middle < 0 ? at_high : at_low) = at_middle;
  }
  return low;
}

}  // namespace

Metres Projection::greatest(Unit step) const {
  Metres most = lines[0].at + part(lines[0].rate, step);
  for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i)
    most = std::max(most, lines[i].at + part(lines[i].rate, step));
  return most;
}

Unit safe_step(const SeparatedPair& pair, Unit rest, Projections& scratch) {
  project(pair, {}, scratch);
  Unit step = step_by_speed(scratch, pair.reserve, rest);
  if (step < rest) step = step_by_vertices(scratch, pair.reserve, step, rest);
  for (const MovingCore* body : {&pair.a, &pair.b}) {
    if (step == rest || body->sweep.rotation == RotationVector{}) continue;
    project(pair, {body}, scratch);
    // Extends the safe step where this frame's bound still has room at it.
    const bool further = excess_after(scratch, pair.reserve, step) >= 0;
    if (further) step = step_by_vertices(scratch, pair.reserve, step, rest);
  }
  return step;
}

// The bound is concave: where it is positive at both ends it is so between them.
bool stays_parted(const SeparatedPair& pair, const MovingCore& body, Projections& scratch) {
  LKS_ASSERT(&body == &pair.a || &body == &pair.b);
  project(pair, {&body}, scratch);
  return excess_after(scratch, pair.reserve, {}) > 0 &&
         excess_after(scratch, pair.reserve, Unit::from_integer(1)) > 0;
}

}  // namespace lockstone::geometry
