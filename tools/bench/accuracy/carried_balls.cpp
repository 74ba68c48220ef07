// Row 30: a box slides under 25 balls that roll on it (J. Hwangbo, D. Kang, "SimBenchmark", 2018,
// the rolling test).
#include <algorithm>

#include "tools/bench/accuracy/contact_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

// A thousand times as heavy and as hard as in the source, so that densities are exact.
constexpr double k_box_mass = 10e3, k_ball_mass = 1e3, k_push = 150e3, k_seconds = 4;
constexpr double k_ground_friction = 0.4;
constexpr int k_side = 5, k_balls = k_side * k_side;

struct Accelerations {
  double box, ball;
};

// The box pulls each ball with f = m·a₂; a ball that rolls on it has a₁ = 3.5·a₂.
Accelerations expected() {
  const double friction = k_ground_friction * (k_box_mass + k_balls * k_ball_mass) * k_gravity;
  const double pull = (k_push - friction) / (3.5 * k_box_mass / k_ball_mass + k_balls);
  return {(k_push - friction - k_balls * pull) / k_box_mass, pull / k_ball_mass};
}

// Friction of the pair is the square root of the product: 0.4 with the ground, 0.8 with balls.
constexpr Coefficient k_friction_of_ground = Coefficient::from_ratio(1, 5);
constexpr Coefficient k_friction_of_box = Coefficient::from_ratio(4, 5);

BodyHandle add_all(SceneRun& scene, std::vector<BodyHandle>& balls) {
  scene.add(ground(k_friction_of_ground));
  BodyDef box = body_at(Shape::box(10_m, 0.5_m, 10_m), 0, 0.5, 0);
  box.material.density = fixed<Density>(k_box_mass / 400);
  box.material.friction = k_friction_of_box;
  const BodyHandle carrier = scene.add(box);
  for (int i = 0; i < k_balls; ++i) {
    BodyDef ball = body_at(Shape::sphere(0.5_m), i % k_side * 2.0 - 4, 1.5, i / k_side * 2.0 - 4);
    ball.material.density = fixed<Density>(k_ball_mass / (std::numbers::pi / 6));
    ball.material.friction = k_friction_of_box;
    balls.push_back(scene.add(ball));
  }
  return carrier;
}

// The worst relative error of a velocity, of box and balls, along the push and across it.
double worst_error(SceneRun& scene, double heading) {
  std::vector<BodyHandle> balls;
  const BodyHandle box = add_all(scene, balls);
  scene.run(1);
  const Vec3<Force> push = fixed<Force>(k_push * std::cos(heading), 0, k_push * std::sin(heading));
  for (int tick = 0; tick < static_cast<int>(k_seconds) * scene.setting().tick_rate; ++tick) {
    (void)scene.world().apply(ApplyForce{box, push});
    scene.step();
  }
  const auto error_of = [&](BodyHandle body, double acceleration) {
    const fuzz::Real3 v = fuzz::real(scene.world().velocity(body));
    const double speed = acceleration * k_seconds;
    const double along = v.x * std::cos(heading) + v.z * std::sin(heading);
    const double across = v.z * std::cos(heading) - v.x * std::sin(heading);
    return std::max(std::abs(along / speed - 1), std::abs(across / speed));
  };
  const Accelerations wanted = expected();
  double worst = error_of(box, wanted.box);
  for (const BodyHandle ball : balls)
    worst = std::max(worst, error_of(ball, wanted.ball));
  return worst;
}

}  // namespace

std::vector<AccuracyResult> measure_carried_balls(const AccuracyOptions& options) {
  constexpr int k_headings = 16;
  return at_settings(options, [](const Setting& setting) {
    SceneRun scene(setting, contact_world());
    double worst = 0, straight = 0;
    for (int i = 0; i < k_headings; ++i) {
      scene = SceneRun(setting, contact_world());
      const double error = worst_error(scene, 2 * std::numbers::pi * i / k_headings);
      if (i == 0) straight = error;
      worst = std::max(worst, error);
    }
    AccuracyResult result = scene.result("16 headings: speeds after 4 s", "relative", worst, 5e-3);
    result.note = "along x " + std::to_string(straight);
    return result;
  });
}

}  // namespace lockstone::bench
