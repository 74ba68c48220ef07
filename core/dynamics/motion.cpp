#include "core/dynamics/motion.h"

#include <algorithm>

#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

// gravity · gravity_scale
Vec3<Acceleration> gravity_on(const BodyRecord& body, const Vec3<Acceleration>& gravity) {
  if (!body.is_dynamic()) return {};
  if (body.gravity_scale == Number::from_integer(1)) return gravity;
  const auto scale = [&](Acceleration g) { return multiply<Acceleration>(g, body.gravity_scale); };
  return {scale(gravity.x), scale(gravity.y), scale(gravity.z)};
}

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

void damp(Vec3<Velocity>& v, Rate damping, const TimeStep& step) {
  if (damping.raw == 0) return;
  // 1 / (1 + c/rate) = rate / (rate + c)
  const std::int64_t rate_q20 = std::int64_t{step.tick_rate} << 20;
  const auto factor =
      static_cast<std::int32_t>(raw::round_divide(rate_q20 << 30, rate_q20 + damping.raw));
  for (int i = 0; i < 3; ++i)
    v[i].raw = raw::multiply_shift(v[i].raw, factor, 30);
}

// Shortens `v` by limit / |w| when |w| exceeds the speed limit.
bool shorten(Vec3<Velocity>& v, const Vec3<Velocity>& w) {
  constexpr std::int64_t k_limit = k_speed_limit.raw;
  const auto within = [](Velocity x) { return x.raw <= k_limit / 2 && x.raw >= -k_limit / 2; };
  if (within(w.x) && within(w.y) && within(w.z)) return false;
  const std::uint64_t speed = norm(w.x.raw, w.y.raw, w.z.raw);
  if (speed <= static_cast<std::uint64_t>(k_limit)) return false;
  const auto ratio = static_cast<std::int32_t>(
      raw::round_divide(k_limit << 20, static_cast<std::int64_t>(speed >> 10)));  // Q30
  for (int i = 0; i < 3; ++i)
    v[i].raw = raw::multiply_shift(v[i].raw, ratio, 30);
  return true;
}

void turn_free(BodyRecord& body, const Mat3& rotation, const TimeStep& step) {
  if (!body.rotates() || body.spin == Vec3<Velocity>{}) return;
  const auto angle = [&](const Mat3& r, std::int64_t divisor) {
    const Vec3<Velocity> w = surface_velocity(inverse_inertia(body, r), body.spin);
    return to_rotation(divided(w, divisor), body.scale_exponent);
  };
  if (body.has_spherical_inertia() || !body.is_dynamic()) {
    body.orientation = integrate(body.orientation, angle(rotation, step.tick_rate));
    return;
  }
  const Quat half = integrate(body.orientation, angle(rotation, std::int64_t{2} * step.tick_rate));
  body.orientation = integrate(body.orientation, angle(to_matrix(half), step.tick_rate));
}

}  // namespace

void apply_damping(BodyRecord& body, const TimeStep& step) {
  damp(body.velocity, body.linear_damping, step);
  damp(body.spin, body.angular_damping, step);
}

bool limit_speed(BodyRecord& body, const InverseInertia& inertia) {
  const bool too_fast = shorten(body.velocity, body.velocity);
  const bool spins_too_fast = shorten(body.spin, surface_velocity(inertia, body.spin));
  return too_fast || spins_too_fast;
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
  return limited;
}

void fly(BodyRecord& body, const Mat3& rotation, const Vec3<Acceleration>& gravity,
         const TimeStep& step, std::uint64_t tick) {
  const Vec3<Acceleration> g = gravity_on(body, gravity);
  const auto phase = static_cast<std::int64_t>(tick % static_cast<std::uint64_t>(step.tick_rate));
  const auto in_this_tick = [&](std::int64_t per_second, std::int64_t rate) {
    return raw::round_divide(per_second * (phase + 1), rate) -
           raw::round_divide(per_second * phase, rate);
  };
  for (int i = 0; i < 3; ++i) {
    const std::int64_t gain = in_this_tick(g[i].raw, step.tick_rate);
    // (v + gain/2)·dt
    body.position[i].raw +=
        in_this_tick(2 * body.velocity[i].raw + gain, std::int64_t{2} * step.tick_rate);
    body.velocity[i].raw += gain;
  }
  turn_free(body, rotation, step);
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

SolverBody begin_substeps(const BodyRecord& body, const Mat3& rotation,
                          const Vec3<Acceleration>& gravity, const TimeStep& step) {
  SolverBody solver;
  const Vec3<Acceleration> g = gravity_on(body, gravity);
  for (int i = 0; i < 3; ++i) {
    const auto lane = static_cast<std::size_t>(i);
    solver.velocity[lane] = body.velocity[i].raw;
    solver.spin[lane] = body.spin[i].raw;
    solver.gravity_step[lane] = raw::round_divide(g[i].raw, step.substep_rate());
  }
  solver.inverse_inertia = inverse_inertia(body, rotation);
  return solver;
}

void integrate_velocity(SolverBody& body) {
  for (std::size_t i = 0; i < 3; ++i)
    body.velocity[i] += body.gravity_step[i];
}

void integrate_position(SolverBody& body, const TimeStep& step) {
  const Vec3<Velocity> w = surface_velocity(
      body.inverse_inertia, {Velocity::from_raw(body.spin[0]), Velocity::from_raw(body.spin[1]),
                             Velocity::from_raw(body.spin[2])});
  for (int i = 0; i < 3; ++i) {
    const auto lane = static_cast<std::size_t>(i);
    body.displacement[lane] += step.substep.times(body.velocity[lane]);
    body.turn[lane] += step.substep.times(w[i].raw);
  }
}

void end_substeps(BodyRecord& body, const SolverBody& solved) {
  const auto lanes = [](const Lanes64& v) {
    return Vec3<Velocity>{Velocity::from_raw(v[0]), Velocity::from_raw(v[1]),
                          Velocity::from_raw(v[2])};
  };
  for (int i = 0; i < 3; ++i) {
    body.position[i].raw += solved.displacement[static_cast<std::size_t>(i)];
  }
  if (body.is_dynamic()) {
    body.velocity = lanes(solved.velocity);
    body.spin = lanes(solved.spin);
  }
  if (solved.turn == Lanes64{}) return;
  body.orientation =
      integrate(body.orientation, to_rotation(lanes(solved.turn), body.scale_exponent));
}

}  // namespace lockstone
