// Rows 7, 15, 16 and 35: pendulums and a top on joints.
#include <algorithm>
#include <array>
#include <cmath>

#include <lockstone/literals.h>

#include "tools/bench/accuracy/joint_scene.h"
#include "tools/bench/accuracy/reference_pendulum.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr double k_gravity = 9.81;
constexpr double k_seconds = 60;

// A pendulum by its shape, let go at 90°: arm to its centre, square of its radius of gyration.
struct Pendulum {
  Shape shape;
  Length arm;
  double gyration;
};

struct Swing {
  double period = 0;
  double worst_energy = 0;  // per m·g·l
};

// Where it is at a crossing of the lowest point is found from angle and rate a moment after it.
Swing swing(SceneRun& scene, const Pendulum& pendulum) {
  const double arm = std::ldexp(pendulum.arm.raw, -20);
  BodyDef bob;
  bob.shape = pendulum.shape;
  bob.position.x = rounded<Position>(pendulum.arm);
  const BodyHandle body = scene.add(bob);
  JointDef joint = JointDef::of(JointKind::ball, scene.add(fixed_point()), body);
  joint.frame_b.position.x = -pendulum.arm;
  join(scene.world(), joint);
  Swing result;
  double first = 0, last = 0, before = 1;
  int crossings = -1;
  for (int tick = 1; tick <= k_seconds * scene.setting().tick_rate; ++tick) {
    scene.step();
    const BodyView view = scene.world().body(body);
    const fuzz::Real3 x = fuzz::real(view.centre_of_mass), v = fuzz::real(view.velocity);
    const double rate = fuzz::real(view.angular_velocity.z), angle = std::atan2(x.x, -x.y);
    const double kinetic = 0.5 * (v.x * v.x + v.y * v.y + pendulum.gyration * rate * rate);
    result.worst_energy =
        std::max(result.worst_energy, std::abs(kinetic / (k_gravity * arm) + x.y / arm));
    if ((before > 0) != (angle > 0)) {
      last = static_cast<double>(tick) / scene.setting().tick_rate - angle / rate;
      if (++crossings == 0) first = last;
    }
    before = angle;
  }
  result.period = 2 * (last - first) / crossings;
  return result;
}

std::vector<AccuracyResult> measure(const Pendulum& pendulum, double period_goal,
                                    double energy_goal) {
  const double arm = std::ldexp(pendulum.arm.raw, -20);
  const double period = 4 * elliptic_k(std::sqrt(0.5)) *
                        std::sqrt((arm * arm + pendulum.gyration) / (k_gravity * arm));
  std::vector<AccuracyResult> energies;
  std::vector<AccuracyResult> results = over_substeps([&](const Setting& setting) {
    SceneRun scene(setting, joint_world());
    const Swing swung = swing(scene, pendulum);
    energies.push_back(scene.result("energy", "of mgl", swung.worst_energy, energy_goal));
    return scene.result("period", "relative", std::abs(swung.period / period - 1), period_goal);
  });
  results.insert(results.end(), energies.begin(), energies.end());
  return results;
}

double double_pendulum_error(SceneRun& scene, const std::array<double, 2>& expected) {
  BodyHandle last = scene.add(fixed_point());
  for (int i = 1; i <= 2; ++i) {
    BodyDef bob;
    bob.shape = Shape::sphere(0.1_m);
    bob.position.x = Position::from_integer(i);
    JointDef joint = JointDef::of(JointKind::ball, last, scene.add(bob));
    joint.frame_b.position.x = -1_m;
    join(scene.world(), joint);
    last = joint.body_b;
  }
  scene.run(5);
  const fuzz::Real3 at = fuzz::real(scene.world().position(last));
  return std::hypot(at.x - std::sin(expected[0]) - std::sin(expected[1]),
                    at.y + std::cos(expected[0]) + std::cos(expected[1]));
}

// A disc on a horizontal axle of 0.3 m goes round at m·g·l / (I₃·ω₃), about the vertical.
double precession_error(SceneRun& scene) {
  constexpr double k_spin = 60, k_arm = 0.3, k_axial = 0.06;
  const double rate = k_gravity * k_arm / (k_axial * k_spin);
  BodyDef disc;
  disc.shape = Shape::box(0.05_m, 0.3_m, 0.3_m);
  disc.position.x = 0.3_m;
  disc.angular_velocity = {
      60_rps, AngularVelocity::from_raw(std::llround(std::ldexp(rate, 32))), {}};
  disc.velocity.z = Velocity::from_raw(-std::llround(std::ldexp(rate * k_arm, 32)));
  const BodyHandle top = scene.add(disc);
  JointDef joint = JointDef::of(JointKind::ball, scene.add(fixed_point()), top);
  joint.frame_b.position.x = -0.3_m;
  join(scene.world(), joint);
  double angle = 0, before = 0;
  for (int tick = 0; tick < 10 * scene.setting().tick_rate; ++tick) {
    scene.step();
    const fuzz::Real3 at = fuzz::real(scene.world().position(joint.body_b));
    const double now = std::atan2(-at.z, at.x);
    angle += std::remainder(now - before, 2 * std::acos(-1.0));
    before = now;
  }
  return std::abs(angle / (10 * rate) - 1);
}

}  // namespace

std::vector<AccuracyResult> measure_top(const AccuracyOptions&) {
  return over_substeps([](const Setting& setting) {
    SceneRun scene(setting, joint_world());
    const double error = precession_error(scene);
    return scene.result("precession", "relative", error, 0.01);
  });
}

std::vector<AccuracyResult> measure_pendulum(const AccuracyOptions&) {
  return measure({Shape::sphere(0.1_m), 1_m, 0.4 * 0.01}, 3e-5, 3e-5);
}

std::vector<AccuracyResult> measure_rod_pendulum(const AccuracyOptions&) {
  return measure({Shape::box(0.5_m, 0.02_m, 0.02_m), 0.5_m, (1 + 0.0016) / 12}, 1e-4, 1e-3);
}

std::vector<AccuracyResult> measure_double_pendulum(const AccuracyOptions&) {
  const std::array<double, 2> expected = double_pendulum_angles(5, k_gravity, 0.004);
  return over_substeps([&](const Setting& setting) {
    SceneRun scene(setting, joint_world());
    const double error = double_pendulum_error(scene, expected);
    return scene.result("end after 5 s", "m", error, 0.1);
  });
}

}  // namespace lockstone::bench
