#include "tools/bench/neutral/judge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/bench/accuracy/reference_pendulum.h"
#include "tools/bench/neutral/references.h"

namespace lockstone::bench {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

using Samples = std::vector<std::vector<BodyState>>;

const BodyState& end_of(const Played& played, std::size_t body = 0) {
  return played.samples.back().at(body);
}

double time_of(const NeutralScene& scene, std::size_t sample) {
  return static_cast<double>(sample + 1) * scene.record_every / k_scene_tick_rate;
}

Triple minus(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double size(const Triple& v) {
  return std::hypot(v[0], v[1], v[2]);
}

double fall(const NeutralScene& scene, const Played& played) {
  return std::abs(end_of(played).position[1] + scene.gravity * scene.seconds * scene.seconds / 2);
}

double drift(const NeutralScene& scene, const Played& played) {
  const Triple went = minus(end_of(played).position, scene.bodies[0].position);
  return size(minus(went, {scene.seconds, 0, 0}));
}

double spin_energy(const NeutralScene& scene, const Played& played) {
  const Spin right = spin_of(scene.bodies[0]);
  double worst = 0;
  for (const auto& sample : played.samples)
    worst = std::max(worst, std::abs(seen_energy(scene.bodies[0], sample[0]) / right.energy - 1));
  return worst;
}

double spin_momentum(const NeutralScene& scene, const Played& played) {
  const Spin right = spin_of(scene.bodies[0]);
  double worst = 0;
  for (const auto& sample : played.samples) {
    const Triple now = seen_momentum(scene.bodies[0], sample[0]);
    worst = std::max(worst, size(minus(now, right.momentum)) / size(right.momentum));
  }
  return worst;
}

double spin_orientation(const NeutralScene& scene, const Played& played) {
  return degrees_off(scene.bodies[0], scene.seconds, end_of(played));
}

// From the kick on, one second after the beginning.
double stopping(const NeutralScene& scene, const Played& played) {
  const double way = end_of(played).position[0] - played.samples.at(59)[0].position[0];
  return std::abs(way / (25 / (2 * scene.friction * scene.gravity)) - 1);
}

// Longest against shortest way, and how far any of them turns aside.
double anisotropy(const NeutralScene& scene, const Played& played) {
  double least = 1e9, most = 0, aside = 0;
  for (std::size_t i = 0; i < scene.kicks.size(); ++i) {
    const Triple way = minus(end_of(played, i).position, played.samples.at(59)[i].position);
    const double x = scene.kicks[i].velocity[0] / 5, z = scene.kicks[i].velocity[2] / 5;
    const double along = way[0] * x + way[2] * z;
    least = std::min(least, along);
    most = std::max(most, along);
    aside = std::max(aside, std::abs(way[2] * x - way[0] * z));
  }
  return std::max(most - least, aside) / most;
}

// When it has gone half a millimetre, against the moment at which one that slips at atan μ has.
double slip_angle(const NeutralScene& scene, const Played& played) {
  constexpr double k_way = 5e-4;
  const double rate = (scene.tilt[2].degrees - scene.tilt[1].degrees) /
                      (scene.tilt[2].time - scene.tilt[1].time) * k_degree;
  const double jerk = scene.gravity * rate * std::hypot(1.0, scene.friction);
  const double late = std::cbrt(6 * k_way / jerk);
  const double start = played.samples.at(59)[0].position[0];
  for (std::size_t i = 60; i < played.samples.size(); ++i) {
    const double went = played.samples[i][0].position[0] - start;
    if (went < k_way) continue;
    // Between two looks: a tick turns gravity by more than engines differ.
    const double before = played.samples[i - 1][0].position[0] - start;
    const double time = time_of(scene, i) - (went - k_way) / (went - before) *
                                                (time_of(scene, i) - time_of(scene, i - 1));
    const double angle = scene.tilt[1].degrees * k_degree + rate * (time - 1 - late);
    return std::abs(angle - std::atan(scene.friction)) / k_degree;
  }
  return (scene.tilt[2].degrees - std::atan(scene.friction) / k_degree);
}

double creep(const NeutralScene&, const Played& played) {
  const Triple went = minus(end_of(played).position, played.samples.at(0)[0].position);
  return std::hypot(went[0], went[2]);
}

double rolling(const NeutralScene& scene, const Played& played) {
  const auto x = [&](std::size_t i) { return played.samples.at(i)[0].position[0]; };
  const double right = 5.0 / 7 * scene.gravity * std::sin(20 * k_degree);
  return std::abs((x(2) - 2 * x(1) + x(0)) / right - 1);
}

double thrown_speed(const NeutralScene& scene, const Played& played) {
  const double right = scene.bodies[1].velocity[0] * 5 / 7;
  return std::abs(end_of(played).velocity[0] / right - 1);
}

double thrown_way(const NeutralScene& scene, const Played& played) {
  const double v0 = scene.bodies[1].velocity[0], a = scene.friction * scene.gravity;
  const double t = 2 * v0 / (7 * a);
  const double right = v0 * t - a * t * t / 2 + v0 * 5 / 7 * (scene.seconds - t);
  return std::abs(end_of(played).position[0] - right);
}

// The height that a ball keeps, at the end: h + v²/2g.
double kept_height(const NeutralScene& scene, const Played& played) {
  const BodyState& end = end_of(played);
  return end.position[1] - scene.bodies[1].size[0] +
         end.velocity[1] * end.velocity[1] / (2 * scene.gravity);
}

double apex(const NeutralScene& scene, const Played& played) {
  return std::abs(kept_height(scene, played) - 0.64);
}

double bounced_energy(const NeutralScene& scene, const Played& played) {
  return std::abs(kept_height(scene, played) - 1);
}

// The speed of each ball: only the last moves.
double cradle(const NeutralScene& scene, const Played& played) {
  double worst = 0;
  for (std::size_t i = 0; i < scene.watched.size(); ++i) {
    const double right = i + 1 == scene.watched.size() ? 1 : 0;
    worst = std::max(worst, std::abs(end_of(played, i).velocity[0] - right));
  }
  return worst;
}

double height_lost(const NeutralScene& scene, const Played& played) {
  return std::abs(end_of(played).position[1] - scene.bodies.back().position[1]);
}

double aside(const NeutralScene&, const Played& played) {
  return std::hypot(end_of(played).position[0], end_of(played).position[2]);
}

double sunk(const NeutralScene& scene, const Played& played) {
  double worst = 0;
  for (const auto& sample : played.samples)
    worst = std::max(worst, std::abs(scene.bodies.back().position[1] - sample[0].position[1]));
  return worst;
}

double swing_period(const NeutralScene& scene, const Played& played) {
  const double right = pendulum_period(scene.bodies[1], scene.gravity);
  return std::abs(seen_period(played.samples) / right - 1);
}

double swing_energy(const NeutralScene& scene, const Played& played) {
  double worst = 0;
  for (const auto& sample : played.samples)
    worst = std::max(worst, std::abs(pendulum_energy(scene.bodies[1], scene.gravity, sample[0])));
  return worst;
}

double double_swing(const NeutralScene& scene, const Played& played) {
  static const std::array<double, 2> angles =
      double_pendulum_angles(scene.seconds, scene.gravity, scene.bodies[1].moments_over_mass()[2]);
  const Triple& at = end_of(played, 1).position;
  return std::hypot(at[0] - std::sin(angles[0]) - std::sin(angles[1]),
                    at[1] + std::cos(angles[0]) + std::cos(angles[1]));
}

double precession(const NeutralScene& scene, const Played& played) {
  double angle = 0, before = 0;
  for (const auto& sample : played.samples) {
    const double now = std::atan2(-sample[0].position[2], sample[0].position[0]);
    angle += std::remainder(now - before, 2 * std::numbers::pi);
    before = now;
  }
  return std::abs(angle / (scene.bodies[1].angular_velocity[1] * scene.seconds) - 1);
}

// Of a scene whose bodies are all watched: the worst distance of two joined points.
double worst_gap(const NeutralScene& scene, const Played& played) {
  double worst = 0;
  const auto at = [](const BodyState& state, const Triple& anchor) {
    const Triple turned = turn(state.orientation, anchor);
    return Triple{state.position[0] + turned[0], state.position[1] + turned[1],
                  state.position[2] + turned[2]};
  };
  for (const auto& sample : played.samples) {
    for (const NeutralJoint& joint : scene.joints) {
      const Triple a = at(sample.at(static_cast<std::size_t>(joint.a)), joint.anchor_a);
      const Triple b = at(sample.at(static_cast<std::size_t>(joint.b)), joint.anchor_b);
      const double gap = size(minus(a, b));
      if (!(gap <= worst)) worst = gap;
    }
  }
  return worst;
}

double stretch(const NeutralScene& scene, const Played& played) {
  const double right = scene.bodies.back().position[0];
  double worst = 0;
  for (const auto& sample : played.samples) {
    const double reach = size(sample.back().position) / right - 1;
    if (!(reach <= worst)) worst = reach;
  }
  return worst;
}

constexpr JudgedError k_errors[] = {
    {"free-fall", 1, "free-fall", "free fall, 10 s: place", "m", 1e-6, fall},
    {"far-drift", 2, "far-drift", "1 m/s for 10 s, 100 km away: place", "m", 1e-8, drift},
    {"tumble", 4, "tumble-energy", "torque-free box, 60 s: energy", "relative", 1e-5, spin_energy},
    {"tumble", 5, "tumble-momentum", "torque-free box, 60 s: angular momentum", "relative", 1e-7,
     spin_momentum},
    {"top", 7, "top", "heavy top, 10 s: precession", "relative", 0.01, precession},
    {"slide", 8, "slide", "box stops from 5 m/s: way", "relative", 2e-4, stopping},
    {"slide-headings", 9, "slide-headings", "the same in 24 headings: spread", "relative", 1e-5,
     anisotropy},
    {"slip", 10, "slip", "slip angle on a slope that turns", "degrees", 0.005, slip_angle},
    {"creep", 10, "creep", "creep on 20 degrees in 60 s", "m", 0, creep},
    {"roll", 11, "roll", "sphere rolls down 20 degrees: acceleration", "relative", 1e-5, rolling},
    {"bounce", 12, "bounce", "sphere drops 1 m, e = 0.8: first apex", "m", 5e-4, apex},
    {"bounces", 13, "bounces", "e = 1: energy after 20 bounces", "relative", 0.01, bounced_energy},
    {"cradle", 14, "cradle", "Newton's cradle: worst speed", "m/s", 0.01, cradle},
    {"pendulum", 15, "pendulum-period", "pendulum from 90 degrees, 60 s: period", "relative", 3e-5,
     swing_period},
    {"pendulum", 15, "pendulum-energy", "pendulum from 90 degrees, 60 s: energy", "of mgl", 3e-5,
     swing_energy},
    {"double-pendulum", 16, "double-pendulum", "double pendulum, 5 s: place", "m", 0, double_swing},
    {"chain", 18, "chain", "chain of 10, 100 : 1, 20 s: worst joint", "m", 5e-3, worst_gap},
    {"stack-20", 19, "stack-20-height", "stack of 20, 60 s: height lost", "m", 1e-3, height_lost},
    {"stack-20", 19, "stack-20-drift", "stack of 20, 60 s: drift", "m", 1e-4, aside},
    {"stack-40", 19, "stack-40-height", "stack of 40, 60 s: height lost", "m", 1e-3, height_lost},
    {"heavy-10", 20, "heavy-10", "10 : 1 on a light box: sunk", "m", 1e-4, sunk},
    {"heavy-100", 20, "heavy-100", "100 : 1 on a light box: sunk", "m", 1e-3, sunk},
    {"heavy-1000", 20, "heavy-1000", "1000 : 1 on a light box: sunk", "m", 2e-3, sunk},
    {"dzhanibekov", 27, "dzhanibekov", "Dzhanibekov's body, 2 s: orientation", "degrees", 0.01,
     spin_orientation},
    {"rod", 28, "rod", "rod, I = (.1, 2, 2.05), 10 s: orientation", "degrees", 0.01,
     spin_orientation},
    {"throw", 29, "throw-speed", "thrown sphere: speed once it rolls", "relative", 2e-4,
     thrown_speed},
    {"throw", 29, "throw-way", "thrown sphere: way in 2 s", "m", 2e-3, thrown_way},
    {"rod-pendulum", 35, "rod-pendulum-period", "rod pendulum, 60 s: period", "relative", 1e-4,
     swing_period},
    {"rod-pendulum", 35, "rod-pendulum-energy", "rod pendulum, 60 s: energy", "of mgl", 1e-3,
     swing_energy},
    {"heavy-chain", 36, "heavy-chain", "chain of 20, 1000 : 1, 10 s: stretch", "relative", 1e-3,
     stretch},
    {"pyramid", 0, "pyramid", "pyramid of 210 boxes, 5 s: height lost", "m", 0, height_lost},
    {"net", 0, "net", "net of 20 x 20 balls, 5 s: worst joint", "m", 0, worst_gap},
};

}  // namespace

std::span<const JudgedError> judged_errors() {
  return k_errors;
}

double judge(const JudgedError& error, const NeutralScene& scene, const Played& played) {
  const double value = error.error(scene, played);
  return value <= k_lost ? std::max(value, k_least_error) : k_lost;
}

}  // namespace lockstone::bench
