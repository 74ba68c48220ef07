// Rows 1 and 2: fall and drift of bodies without contacts.
#include <algorithm>
#include <cmath>

#include <lockstone/literals.h>

#include "tools/bench/accuracy/scene_run.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr double k_seconds = 10;

WorldDef small_world() {
  WorldDef def;
  def.body_capacity = 4;
  def.pair_capacity = def.contact_capacity = 16;
  return def;
}

double fall_error(SceneRun& scene) {
  const BodyHandle body = scene.add({});
  scene.run(k_seconds);
  return std::abs(fuzz::real(scene.world().position(body).y) + 0.5 * 9.81 * k_seconds * k_seconds);
}

double drift_error(SceneRun& scene, Position away) {
  BodyDef def;
  def.position = {away, away, -away};
  def.velocity = {1_mps, {}, {}};
  const BodyHandle body = scene.add(def);
  scene.run(k_seconds);
  const fuzz::Real3 went = fuzz::real(scene.world().position(body) - def.position);
  return fuzz::norm(went - fuzz::Real3{k_seconds, 0, 0});
}

}  // namespace

std::vector<AccuracyResult> measure_free_fall(const AccuracyOptions&) {
  return over_substeps([](const Setting& setting) {
    SceneRun scene(setting, small_world());
    const double error = fall_error(scene);
    return scene.result("fall", "m", error, 1e-6);
  });
}

std::vector<AccuracyResult> measure_drift(const AccuracyOptions&) {
  std::vector<AccuracyResult> results;
  WorldDef def = small_world();
  def.gravity = {};
  for (const std::int64_t kilometres : {0, 100, 1000}) {
    SceneRun scene(k_usual_setting, def);
    const double error = drift_error(scene, Position::from_integer(1000 * kilometres));
    results.push_back(scene.result("from " + std::to_string(kilometres) + " km", "m", error, 1e-8));
  }
  return results;
}

}  // namespace lockstone::bench
