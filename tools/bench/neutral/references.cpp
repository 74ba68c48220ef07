#include "tools/bench/neutral/references.h"

#include <cmath>
#include <numbers>

#include "tools/bench/accuracy/reference_pendulum.h"
#include "tools/bench/accuracy/reference_rotation.h"

namespace lockstone::bench {
namespace {

constexpr int k_reference_rate = 6000;  // steps a second

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

std::array<double, 4> conjugate_of(const std::array<double, 4>& q) {
  return {-q[0], -q[1], -q[2], q[3]};
}

}  // namespace

// v + 2 u × (u × v + w v), u the vector part; for quaternions that are not quite of norm 1 too.
Triple turn(const std::array<double, 4>& orientation, const Triple& v) {
  const double norm = std::sqrt(orientation[0] * orientation[0] + orientation[1] * orientation[1] +
                                orientation[2] * orientation[2] + orientation[3] * orientation[3]);
  const Triple u{orientation[0] / norm, orientation[1] / norm, orientation[2] / norm};
  Triple inner = cross(u, v);
  for (std::size_t i = 0; i < 3; ++i)
    inner[i] += v[i] * orientation[3] / norm;
  const Triple outer = cross(u, inner);
  return {v[0] + 2 * outer[0], v[1] + 2 * outer[1], v[2] + 2 * outer[2]};
}

Triple seen_momentum(const NeutralBody& body, const BodyState& state) {
  Triple w = turn(conjugate_of(state.orientation), state.angular_velocity);
  const Triple moments = body.moments_over_mass();
  for (std::size_t i = 0; i < 3; ++i)
    w[i] *= moments[i];
  return turn(state.orientation, w);
}

double seen_energy(const NeutralBody& body, const BodyState& state) {
  return dot(seen_momentum(body, state), state.angular_velocity) / 2;
}

Spin spin_of(const NeutralBody& body) {
  BodyState start;
  start.angular_velocity = body.angular_velocity;
  return {seen_energy(body, start), seen_momentum(body, start)};
}

double degrees_off(const NeutralBody& body, double seconds, const BodyState& seen) {
  const Triple moments = body.moments_over_mass(), momentum = spin_of(body).momentum;
  const FreeBody free{{moments[0], moments[1], moments[2]},
                      {momentum[0], momentum[1], momentum[2]}};
  const LongQuat right =
      turn_freely(free, {}, seconds, static_cast<int>(std::lround(seconds * k_reference_rate)));
  const auto& q = seen.orientation;
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const LongQuat now{q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
  return static_cast<double>(angle_between(right, now)) * 180 / std::numbers::pi;
}

double pendulum_period(const NeutralBody& bob, double gravity) {
  const double arm = bob.position[0], gyration = bob.moments_over_mass()[2];
  return 4 * elliptic_k(std::sqrt(0.5)) * std::sqrt((arm * arm + gyration) / (gravity * arm));
}

double pendulum_energy(const NeutralBody& bob, double gravity, const BodyState& state) {
  const double rate = state.angular_velocity[2], gyration = bob.moments_over_mass()[2];
  const double kinetic = (dot(state.velocity, state.velocity) + gyration * rate * rate) / 2;
  return (kinetic / gravity + state.position[1]) / bob.position[0];
}

// Each passing is found from angle and rate a moment after it.
double seen_period(const std::vector<std::vector<BodyState>>& samples) {
  double first = 0, last = 0, before = 1;
  int crossings = -1;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BodyState& state = samples[i][0];
    const double angle = std::atan2(state.position[0], -state.position[1]);
    if ((before > 0) != (angle > 0)) {
      last = static_cast<double>(i + 1) / k_scene_tick_rate - angle / state.angular_velocity[2];
      if (++crossings == 0) first = last;
    }
    before = angle;
  }
  return 2 * (last - first) / crossings;
}

}  // namespace lockstone::bench
