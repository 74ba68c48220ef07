// Rows 3, 8, 9, 10, 11 and 29: damping, sliding, sticking and rolling.
#include <algorithm>

#include "tools/bench/accuracy/contact_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr double k_friction = 0.5;

// A box at rest on the ground, its contact settled.
BodyHandle settled_box(SceneRun& scene) {
  scene.add(ground());
  const BodyHandle box = scene.add(body_at(unit_box(), 0, 0.5, 0));
  scene.run(1);
  return box;
}

// Where a box comes to rest that is sent off at 5 m/s.
fuzz::Real3 stopped(SceneRun& scene, double heading) {
  const BodyHandle box = settled_box(scene);
  const fuzz::Real3 start = fuzz::real(scene.world().position(box));
  (void)scene.world().apply(
      SetVelocity{box, fixed<Velocity>(5 * std::cos(heading), 0, 5 * std::sin(heading))});
  scene.run(2);
  return fuzz::real(scene.world().position(box)) - start;
}

// Whether a settled box slides half a millimetre in two seconds, after two of turning gravity.
bool slips(SceneRun& scene, double angle) {
  WorldDef def = contact_world();
  def.gravity = tilted_gravity(20 * k_degree);
  scene = SceneRun(scene.setting(), def);
  const BodyHandle box = settled_box(scene);
  tilt(scene, 20 * k_degree, angle, 2);
  const double start = fuzz::real(scene.world().position(box).x);
  scene.run(2);
  return fuzz::real(scene.world().position(box).x) - start > 5e-4;
}

AccuracyResult slip_angle(const Setting& setting) {
  SceneRun scene(setting, contact_world());
  double sticks = 26 * k_degree, slides = 27.2 * k_degree;
  for (int i = 0; i < 11; ++i) {
    const double middle = (sticks + slides) / 2;
    (slips(scene, middle) ? slides : sticks) = middle;
  }
  const double error = (sticks + slides) / 2 - std::atan(k_friction);
  return scene.result("slip angle", "degrees", std::abs(error) / k_degree, 0.005);
}

AccuracyResult creep(const Setting& setting) {
  WorldDef def = contact_world();
  def.gravity = tilted_gravity(20 * k_degree);
  SceneRun scene(setting, def);
  const BodyHandle box = settled_box(scene);
  const Vec3<Position> start = scene.world().position(box);
  scene.run(60);
  const fuzz::Real3 went = fuzz::real(scene.world().position(box) - start);
  return scene.result("creep at 20 degrees", "m", std::hypot(went.x, went.z), 0);
}

AccuracyResult rolling(const Setting& setting) {
  WorldDef def = contact_world();
  def.gravity = tilted_gravity(20 * k_degree);
  SceneRun scene(setting, def);
  scene.add(ground());
  const BodyHandle ball = scene.add(body_at(Shape::sphere(0.5_m), 0, 0.5, 0));
  double x[3] = {};
  for (double& at : x) {
    scene.run(1);
    at = fuzz::real(scene.world().position(ball).x);
  }
  const double expected = 5.0 / 7 * k_gravity * std::sin(20 * k_degree);
  return scene.result("acceleration", "relative", std::abs((x[2] - 2 * x[1] + x[0]) / expected - 1),
                      1e-5);
}

// Slips until v = 5/7 v₀ at t = 2 v₀ / 7μg.
std::vector<AccuracyResult> thrown(const Setting& setting) {
  constexpr double k_speed = 7, k_mu = 0.3, k_end = 2;
  SceneRun scene(setting, contact_world());
  scene.add(ground(0.3_r));
  BodyDef def = body_at(Shape::sphere(0.5_m), 0, 0.5, 0);
  def.material.friction = 0.3_r;
  def.velocity.x = fixed<Velocity>(k_speed);
  const BodyHandle ball = scene.add(def);
  scene.run(k_end);
  const double t = 2 * k_speed / (7 * k_mu * k_gravity), v = k_speed * 5 / 7;
  const double x = k_speed * t - k_mu * k_gravity * t * t / 2 + v * (k_end - t);
  const double error_v = std::abs(fuzz::real(scene.world().velocity(ball).x) / v - 1);
  const double error_x = std::abs(fuzz::real(scene.world().position(ball).x) - x);
  return {scene.result("speed once it rolls", "relative", error_v, 2e-4),
          scene.result("way in 2 s", "m", error_x, 2e-3)};
}

}  // namespace

std::vector<AccuracyResult> measure_damping(const AccuracyOptions& options) {
  return at_settings(options, [](const Setting& setting) {
    constexpr double k_rate = 0.5, k_time = 10;
    SceneRun scene(setting, contact_world());
    BodyDef def;
    def.velocity = {30_mps, 40_mps, {}};
    def.linear_damping = fixed<Rate>(k_rate);
    const BodyHandle body = scene.add(def);
    scene.run(k_time);
    const double left = (1 - std::exp(-k_rate * k_time)) / k_rate, fall = -k_gravity / k_rate;
    const fuzz::Real3 expected{30 * left, fall * k_time + (40 - fall) * left, 0};
    const fuzz::Real3 error = fuzz::real(scene.world().position(body)) - expected;
    return scene.result("position", "relative", fuzz::norm(error) / fuzz::norm(expected), 1e-5);
  });
}

std::vector<AccuracyResult> measure_stopping(const AccuracyOptions& options) {
  return at_settings(options, [](const Setting& setting) {
    SceneRun scene(setting, contact_world());
    const double way = fuzz::norm(stopped(scene, 0)), expected = 25 / (2 * k_friction * k_gravity);
    return scene.result("stopping distance", "relative", std::abs(way / expected - 1), 2e-4);
  });
}

std::vector<AccuracyResult> measure_anisotropy(const AccuracyOptions& options) {
  constexpr int k_headings = 24;
  return at_settings(options, [](const Setting& setting) {
    double least = 1e9, most = 0, aside = 0;
    SceneRun scene(setting, contact_world());
    for (int i = 0; i < k_headings; ++i) {
      const double heading = 2 * std::numbers::pi * i / k_headings;
      scene = SceneRun(setting, contact_world());
      const fuzz::Real3 way = stopped(scene, heading);
      least = std::min(least, fuzz::norm(way));
      most = std::max(most, fuzz::norm(way));
      aside = std::max(aside, std::abs(way.z * std::cos(heading) - way.x * std::sin(heading)));
    }
    return scene.result("24 headings", "relative", std::max(most - least, aside) / most, 1e-5);
  });
}

std::vector<AccuracyResult> measure_sticking(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results = at_settings(options, slip_angle);
  for (AccuracyResult& result : at_settings(options, creep))
    results.push_back(std::move(result));
  return results;
}

std::vector<AccuracyResult> measure_rolling(const AccuracyOptions& options) {
  return at_settings(options, rolling);
}

std::vector<AccuracyResult> measure_thrown(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  for (int which = 0; which < 2; ++which) {
    for (AccuracyResult& result : at_settings(options, [&](const Setting& setting) {
           return thrown(setting)[static_cast<std::size_t>(which)];
         }))
      results.push_back(std::move(result));
  }
  return results;
}

}  // namespace lockstone::bench
