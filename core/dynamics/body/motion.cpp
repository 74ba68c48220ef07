#include "core/dynamics/body/motion.h"

#include <algorithm>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/body/damping.h"
#include "core/dynamics/body/free_rotation.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/math/roots.h"
#include "core/math/rotation_log.h"

namespace lockstone {
namespace {

// A surface displacement (m, Q32) as a rotation vector (rad, Q32): divided by 2^scale_exponent.
RotationVector to_rotation(const Vec3<Velocity>& turn, int scale_exponent) {
  const auto angle = [&](Velocity x) {
    return RotationComponent::from_raw(raw::scale_binary(x.raw, -scale_exponent));
  };
  return {angle(turn.x), angle(turn.y), angle(turn.z)};
}

Vec3<Velocity> divided(const Vec3<Velocity>& v, std::int64_t divisor) {
  return {Velocity::from_raw(raw::round_divide(v.x.raw, divisor)),
          Velocity::from_raw(raw::round_divide(v.y.raw, divisor)),
          Velocity::from_raw(raw::round_divide(v.z.raw, divisor))};
}

// Most bodies have neither forces nor torques, and gravity along one axis.
std::int64_t part_of(std::int64_t x, std::int64_t count) {
  return x == 0 ? 0 : raw::round_divide(x, count);
}

void damp(Vec3<Velocity>& v, Rate damping, const TimeStep& step) {
  if (damping.raw == 0) return;
  const std::int32_t keep = Damping::of(damping, step).keep;
  for (int i = 0; i < 3; ++i)
    v[i].raw = raw::multiply_shift(v[i].raw, keep, 30);
}

// The way and the velocity of one axis under damping.
void integrate_damped(Position& x, Velocity& v, std::int64_t gain, const Damping& damping,
                      const TimeStep& step) {
  const auto times = [](std::int64_t value, std::int32_t factor) {
    return raw::multiply_shift(value, factor, 30);
  };
  const std::int64_t mean = times(v.raw, damping.ease) + times(gain, damping.mean);
  x.raw += raw::round_divide(mean, step.tick_rate);
  v.raw = times(v.raw, damping.keep) + times(gain, damping.ease);
}

// Shortens `v` by limit / |w| when |w| exceeds it.
bool shorten(Vec3<Velocity>& v, const Vec3<Velocity>& w, Velocity most) {
  LKS_ASSERT(most >= Velocity{});
  const std::int64_t limit = most.raw;
  const auto within = [&](Velocity x) { return x.raw <= limit / 2 && x.raw >= -limit / 2; };
  if (within(w.x) && within(w.y) && within(w.z)) return false;
  const std::uint64_t speed = norm(w.x.raw, w.y.raw, w.z.raw);
  if (speed <= static_cast<std::uint64_t>(limit)) return false;
  const auto ratio = static_cast<std::int32_t>(
      raw::round_divide(limit << 20, static_cast<std::int64_t>(speed >> 10)));  // Q30
  for (int i = 0; i < 3; ++i)
    v[i].raw = raw::multiply_shift(v[i].raw, ratio, 30);
  return true;
}

// Surely, from entries of M that are at most 2^exponent.
bool spins_slowly(const InverseInertia& inertia, const Vec3<Velocity>& spin, Velocity most) {
  const Velocity sum = abs(spin.x) + abs(spin.y) + abs(spin.z);
  return sum.raw <= most.raw >> (2 + inertia.exponent);
}

// Whether it turns evenly about one axis as long as nothing pushes it. With one of two free axes
// locked that is so to first order.
bool turns_evenly(const BodyRecord& body) {
  return body.has_spherical_inertia() || !body.is_dynamic() || (body.locks & k_lock_turning) != 0;
}

std::uint32_t turn(BodyRecord& body, const Mat3& rotation, const Vec3<Velocity>& spin,
                   const TurnTime& time) {
  const FreeTurn turned = turn_freely(body, rotation, spin, time);
  body.orientation = turned.orientation;
  return turned.axis_turns;
}

// ω times a part of a tick.
RotationVector even_turn(const BodyRecord& body, const Mat3& rotation, const TimeStep& step,
                         Unit part) {
  const Vec3<Velocity> w = surface_velocity(inverse_inertia(body, rotation), body.spin);
  Vec3<Velocity> way = divided(w, step.tick_rate);
  if (part != k_whole_tick) {
    for (int i = 0; i < 3; ++i)
      way[i] = times(way[i], part);
  }
  return to_rotation(way, body.scale_exponent);
}

// The axis of a body with one moment below 1/ratio of both others; -1 when there is none.
int thin_axis(const BodyRecord& body, int ratio) {
  LKS_ASSERT(ratio > 1);
  if (!body.is_dynamic()) return -1;
  const auto& [x, y, z] = body.inertia;
  const Unit least = min(x, min(y, z));
  const int axis = least == x ? 0 : least == y ? 1 : 2;
  const Unit other = min(body.inertia[(axis + 1) % 3], body.inertia[(axis + 2) % 3]);
  return std::int64_t{least.raw} * ratio < other.raw ? axis : -1;
}

// Torque about the axis is as that of the impulses at the tick's beginning.
void keep_axial_spin(BodyRecord& body, const Mat3& rotation, const Vec3<Velocity>& mean) {
  constexpr int k_ratio = 8;
  const int axis = thin_axis(body, k_ratio);
  if (axis < 0 || body.spin == mean) return;
  LKS_ASSERT(axis < 3);
  const Vec3<Unit>& before = rotation.column(axis);
  const Vec3<Unit> now = to_matrix(body.orientation).column(axis);
  const Vec3<Velocity> gained = body.spin - mean;
  Velocity lost{};
  for (int i = 0; i < 3; ++i)
    lost += times(gained[i], before[i]) - times(gained[i], now[i]);
  for (int i = 0; i < 3; ++i)
    body.spin[i] += times(lost, now[i]);
}

// θ with as many whole turns more about its axis as bring it nearest to `expected`.
RotationVector with_whole_turns(const RotationVector& theta, const RotationVector& expected) {
  constexpr std::int64_t k_turn = 0x6487ed511;  // 2π, 32 bits
  const Vec3<Unit> axis = direction_of(theta == RotationVector{} ? expected : theta);
  LKS_ASSERT(geometry::is_unit(axis));
  std::int64_t missing = 0;
  for (int i = 0; i < 3; ++i)
    missing += raw::multiply_shift((expected[i] - theta[i]).raw, axis[i].raw, Unit::frac_bits);
  const std::int64_t turns = raw::round_divide(missing, k_turn) * k_turn;
  RotationVector result = theta;
  for (int i = 0; i < 3; ++i)
    result[i].raw += raw::multiply_shift(turns, axis[i].raw, Unit::frac_bits);
  return result;
}

}  // namespace

Vec3<Acceleration> gravity_on(const BodyRecord& body, const Vec3<Acceleration>& gravity) {
  if (!body.is_dynamic()) return {};
  Vec3<Acceleration> g = gravity;
  for (int i = 0; i < 3; ++i) {
    if (body.gravity_scale != Number::from_integer(1))
      g[i] = multiply<Acceleration>(g[i], body.gravity_scale);
    if (body.is_locked(i)) g[i] = {};
  }
  return g;
}

bool is_slower_than(const BodyRecord& body, int exponent) {
  LKS_ASSERT(exponent <= 0 && exponent + Velocity::frac_bits >= 0);
  const std::int64_t bound = std::int64_t{1} << (Velocity::frac_bits + exponent);
  for (int i = 0; i < 3; ++i)
    if (std::abs(body.velocity[i].raw) >= bound || std::abs(body.spin[i].raw) >= bound)
      return false;
  return true;
}

void damp_velocity(BodyRecord& body, const TimeStep& step) {
  damp(body.velocity, body.linear_damping, step);
}

void damp_spin(BodyRecord& body, const TimeStep& step) {
  damp(body.spin, body.angular_damping, step);
}

bool limit_speed(BodyRecord& body, const InverseInertia& inertia, Velocity world_limit) {
  const Velocity most = min(world_limit, rounded<Velocity>(body.max_speed));
  const bool too_fast = shorten(body.velocity, body.velocity, most);
  const Velocity most_spin = rounded<Velocity>(body.max_surface_speed);
  if (spins_slowly(inertia, body.spin, most_spin)) return too_fast;
  const bool spins_too_fast = shorten(body.spin, surface_velocity(inertia, body.spin), most_spin);
  return too_fast || spins_too_fast;
}

void clamp_speed(Vec3<Velocity>& v) {
  for (int i = 0; i < 3; ++i)
    v[i] = clamp(v[i], -k_speed_limit, k_speed_limit);
}

void apply_axis_locks(BodyRecord& body) {
  if (body.locks == 0) return;
  for (int i = 0; i < 3; ++i) {
    if (body.is_locked(i)) body.velocity[i] = {};
    if (body.is_turn_locked(i)) body.spin[i] = {};
  }
}

bool limit_position(BodyRecord& body) {
  bool limited = false;
  for (int i = 0; i < 3; ++i) {
    const Position inside = clamp(body.position[i], -k_world_limit, k_world_limit);
    if (inside == body.position[i]) continue;
    body.position[i] = inside;
    body.velocity[i] = {};
    limited = true;
  }
  LKS_ASSERT(body.position.x <= k_world_limit && body.position.y <= k_world_limit &&
             body.position.z <= k_world_limit);
  return limited;
}

std::uint32_t fly(BodyRecord& body, const Mat3& rotation, const Vec3<Acceleration>& gravity,
                  const TimeStep& step, std::uint64_t tick) {
  LKS_ASSERT(body.moves() && step.tick_rate > 0);
  const Vec3<Acceleration> g = gravity_on(body, gravity);
  const auto phase = static_cast<std::int64_t>(tick % static_cast<std::uint64_t>(step.tick_rate));
  const auto in_this_tick = [&](std::int64_t per_second, std::int64_t rate) {
    if (per_second == 0) return std::int64_t{0};
    return raw::round_divide(per_second * (phase + 1), rate) -
           raw::round_divide(per_second * phase, rate);
  };
  const auto& [force, torque] = tick_gain_of(body);
  const bool damped = body.is_dynamic() && body.linear_damping > Rate{};
  const Damping damping = damped ? Damping::of(body.linear_damping, step) : Damping{};
  for (int i = 0; i < 3; ++i) {
    const std::int64_t gain = in_this_tick(g[i].raw, step.tick_rate) + force[i].raw;
    if (damped) {
      integrate_damped(body.position[i], body.velocity[i], gain, damping, step);
      continue;
    }
    // (v + gain/2)·dt
    body.position[i].raw +=
        in_this_tick(2 * body.velocity[i].raw + gain, std::int64_t{2} * step.tick_rate);
    body.velocity[i].raw += gain;
  }
  const Vec3<Velocity> half = divided(torque, 2);
  body.spin += half;
  const std::uint32_t turns = turn_in_flight(body, rotation, step, k_whole_tick);
  body.spin += torque - half;
  return turns;
}

std::uint32_t turn_in_flight(BodyRecord& body, const Mat3& rotation, const TimeStep& step,
                             Unit part) {
  if (!body.rotates() || body.spin == Vec3<Velocity>{}) return 0;
  if (!turns_evenly(body)) return turn(body, rotation, body.spin, {step.tick_rate, part});
  body.orientation = integrate(body.orientation, even_turn(body, rotation, step, part));
  return 0;
}

RotationVector turn_since(const Quat& start, const Mat3& rotation, const BodyRecord& body,
                          const TimeStep& step, Unit part) {
  constexpr int k_thin = 64;
  constexpr auto k_surely_nearest = RotationComponent::from_ratio(5, 2);  // less than π
  LKS_ASSERT(part >= Unit{} && part <= Unit::from_integer(1));
  const RotationVector nearest = rotation_between(start, body.orientation);
  if (!body.rotates() || body.spin == Vec3<Velocity>{}) return nearest;
  const bool thin = thin_axis(body, k_thin) >= 0;
  const RotationVector expected = thin ? turn_about_momentum(body, {step.tick_rate, part})
                                       : even_turn(body, rotation, step, part);
  if (abs(expected.x) + abs(expected.y) + abs(expected.z) <= k_surely_nearest) return nearest;
  return thin ? expected : with_whole_turns(nearest, expected);
}

Vec3<Velocity> gravity_gain(const BodyRecord& body, const Vec3<Acceleration>& gravity,
                            const TimeStep& step, Unit fraction) {
  const Vec3<Acceleration> g = gravity_on(body, gravity);
  const auto gain = [&](Acceleration x) {
    return Velocity::from_raw(
        raw::multiply_shift(step.tick.times(x.raw), fraction.raw, Unit::frac_bits));
  };
  return {gain(g.x), gain(g.y), gain(g.z)};
}

Vec3<Velocity> tick_gain(const BodyRecord& body, const Vec3<Acceleration>& gravity,
                         const TimeStep& step) {
  const Vec3<Acceleration> g = gravity_on(body, gravity);
  Vec3<Velocity> gain = tick_gain_of(body).velocity;
  for (int i = 0; i < 3; ++i)
    gain[i].raw += raw::round_divide(g[i].raw, step.tick_rate);
  return gain;
}

SolverBody solver_body(const BodyRecord& body, const Mat3& rotation,
                       const Vec3<Acceleration>& gravity, const TimeStep& step) {
  SolverBody solver;
  const auto& [force, torque] = tick_gain_of(body);
  const Vec3<Acceleration> g = gravity_on(body, gravity);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    solver.gain[axis] =
        part_of(g[i].raw, step.substep_rate()) + part_of(force[i].raw, step.substeps);
    solver.spin_gain[axis] = part_of(torque[i].raw, step.substeps);
  }
  solver.locked = body.locks & k_lock_moving;
  solver.inverse_inertia = inverse_inertia(body, rotation);
  solver.inverse_mass = body.inverse_mass_value();
  solver.scale_exponent = body.scale_exponent;
  solver.is_spherical = body.has_spherical_inertia();
  solver.is_plain = solver.locked == 0 && turns_alike(solver.inverse_inertia);
  LKS_ASSERT(solver.inverse_mass.mantissa >= 0 && (body.is_dynamic() || !solver.is_pushed()));
  return solver;
}

std::uint32_t end_substeps(BodyRecord& body, const Mat3& rotation,
                           const Vec3<Velocity>& displacement, const Vec3<Velocity>& turned,
                           const TimeStep& step) {
  LKS_ASSERT(body.moves());
  for (int i = 0; i < 3; ++i)
    body.position[i].raw += displacement[i].raw;
  if (turned == Vec3<Velocity>{}) return 0;
  if (turns_evenly(body)) {
    body.orientation = integrate(body.orientation, to_rotation(turned, body.scale_exponent));
    return 0;
  }
  const auto speed = [&](Velocity way) { return Velocity::from_raw(way.raw * step.tick_rate); };
  const Vec3<Velocity> surface{speed(turned.x), speed(turned.y), speed(turned.z)};
  const Vec3<Velocity> mean = spin_of(body, rotation, surface);
  const std::uint32_t turns = turn(body, rotation, mean, {step.tick_rate});
  keep_axial_spin(body, rotation, mean);
  return turns;
}

}  // namespace lockstone
