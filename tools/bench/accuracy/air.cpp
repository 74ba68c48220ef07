// Row 44: bodies that fall through air, and that wind drives, against the closed forms of quadratic
// drag.
#include <cmath>
#include <numbers>

#include <lockstone/fluid.h>

#include "tools/bench/accuracy/contact_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr double k_air = 307.0 / 256;  // kg/m³, as a density is kept
constexpr double k_form = 0.5, k_wind = 20;
constexpr double k_radius = 0.1, k_ball = 500;  // m, kg/m³

// Air over the whole world.
SceneRun in_air(const Setting& setting, const Vec3<Velocity>& flow, Acceleration gravity) {
  WorldDef def = contact_world();
  def.gravity.y = gravity;
  SceneRun scene(setting, def);
  Fluid air{.surface = {{}, k_world_limit, {}}};
  air.size = {k_world_limit, k_world_limit + k_world_limit, k_world_limit};
  air.density = fixed<Density>(k_air);
  air.drag = fixed<Number>(k_form);
  air.flow = flow;
  (void)scene.world().apply(SetFluid{0, air});
  return scene;
}

BodyDef ball() {
  BodyDef def = body_at(Shape::sphere(fixed<Length>(k_radius)), 0, 0, 0);
  def.material.density = fixed<Density>(k_ball);
  return def;
}

// (ρ_b − ρ)·V·g = ½·ρ·C·A·v²
constexpr double k_fall = k_gravity * (k_ball - k_air) / k_ball;  // m/s², at first
const double k_terminal = std::sqrt(2 * k_fall * k_ball * (4.0 / 3) * k_radius / (k_air * k_form));

AccuracyResult terminal(const Setting& setting) {
  SceneRun scene = in_air(setting, {}, -9.81_mps2);
  const BodyHandle body = scene.add(ball());
  scene.run(60);
  const double speed = -fuzz::real(scene.world().velocity(body).y);
  return scene.result("terminal speed", "relative", std::abs(speed / k_terminal - 1), 1e-5);
}

// v² / g · ln cosh(g·t / v)
AccuracyResult fallen(const Setting& setting) {
  SceneRun scene = in_air(setting, {}, -9.81_mps2);
  const BodyHandle body = scene.add(ball());
  scene.run(10);
  const double way =
      k_terminal * k_terminal / k_fall * std::log(std::cosh(k_fall * 10 / k_terminal));
  const double went = -fuzz::real(scene.world().position(body).y);
  return scene.result("way in 10 s", "relative", std::abs(went / way - 1), 1e-3);
}

// u' = −k·u² of the velocity u against the wind, k = ½·ρ·C·A / m of a plate that faces it.
AccuracyResult driven(const Setting& setting) {
  SceneRun scene = in_air(setting, {fixed<Velocity>(k_wind), {}, {}}, {});
  BodyDef plate = body_at(Shape::box(0.05_m, 1_m, 1_m), 0, 0, 0);
  plate.material.density = fixed<Density>(100);
  const BodyHandle body = scene.add(plate);
  scene.run(10);
  const double k = 0.5 * k_air * k_form / (0.1 * 100);
  const double speed = k_wind - k_wind / (1 + k * k_wind * 10);
  const double moves = fuzz::real(scene.world().velocity(body).x);
  return scene.result("plate in the wind, after 10 s", "relative", std::abs(moves / speed - 1),
                      1e-3);
}

}  // namespace

std::vector<AccuracyResult> measure_air(const AccuracyOptions&) {
  std::vector<AccuracyResult> results;
  for (const auto measure : {terminal, fallen, driven})
    for (AccuracyResult& result : over_tick_rates(measure))
      results.push_back(std::move(result));
  return results;
}

}  // namespace lockstone::bench
