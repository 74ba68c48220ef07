// Row 22: structures without mortar keep standing, and a dropped block of boxes settles.
#include <algorithm>
#include <array>

#include "tools/bench/accuracy/contact_scene.h"
#include "tools/fuzz/dice.h"
#include "tools/scenes/scene.h"

namespace lockstone::bench {
namespace {

std::vector<fuzz::Real3> places(const World& world) {
  std::vector<fuzz::Real3> result;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    result.push_back(fuzz::real(world.position(world.body_at(i))));
  return result;
}

double farthest(const std::vector<fuzz::Real3>& from, const std::vector<fuzz::Real3>& to) {
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    most = std::max(most, fuzz::norm(to[i] - from[i]));
  return most;
}

// How far any body of a scene has gone in ten minutes without sleep. It falls beyond 1 cm.
AccuracyResult stands(const Setting& setting, std::string_view name) {
  const scenes::Scene& scene = *scenes::find_scene(name);
  WorldDef def = scene.define();
  def.sleep_ms = 0;
  std::vector<AssetPtr> assets;
  if (scene.assets != nullptr) assets = scene.assets(1);
  SceneRun run(setting, def, std::make_shared<const AssetSet>(std::move(assets)));
  scene.build(run.world(), 1);
  const std::vector<fuzz::Real3> start = places(run.world());
  run.run(10);
  const double settling = farthest(start, places(run.world()));
  run.run(590);
  const double moved = farthest(start, places(run.world()));
  AccuracyResult result = run.result(std::string(name) + ", 10 min: moved", "m", moved, 1e-2);
  result.note = "in the first 10 s " + std::to_string(settling * 1000) + " mm";
  return result;
}

double fastest(const World& world) {
  double most = 0;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    most = std::max(most, fuzz::norm(fuzz::real(world.velocity(world.body_at(i)))));
  return most;
}

// Six layers of six by six, a tenth of their size apart, each box out of line by up to 2 cm.
void add_block(SceneRun& scene, std::uint64_t seed) {
  scene.add(ground());
  fuzz::Dice dice(seed, 22);
  for (int i = 0; i < 216; ++i) {
    const fuzz::Real3 off = dice.in_cube(0.02);
    scene.add(body_at(unit_box(), (i % 6) * 1.1 + off.x, 1.5 + (i / 36) * 1.1,
                      (i / 6 % 6) * 1.1 + off.z));
  }
}

std::array<AccuracyResult, 2> block_of_boxes(const Setting& setting, std::uint64_t seed) {
  SceneRun scene(setting, contact_world(256));
  add_block(scene, seed);
  scene.run(60);
  const std::vector<fuzz::Real3> settled = places(scene.world());
  const double speed = fastest(scene.world());
  scene.run(60);
  const double moved = farthest(settled, places(scene.world()));
  return {scene.result("6 x 6 x 6 boxes: fastest after 60 s", "m/s", speed, 1e-3),
          scene.result("the same: moved in the next 60 s", "m", moved, 1e-3)};
}

}  // namespace

std::vector<AccuracyResult> measure_standing(const AccuracyOptions& options) {
  std::vector<AccuracyResult> results;
  const auto add = [&](auto&& measure) {
    for (AccuracyResult& result : at_settings(options, measure))
      results.push_back(std::move(result));
  };
  for (const char* name : {"arch", "cards"})
    add([&](const Setting& setting) { return stands(setting, name); });
  for (std::size_t which = 0; which < 2; ++which)
    add([&](const Setting& setting) { return block_of_boxes(setting, options.seed)[which]; });
  return results;
}

}  // namespace lockstone::bench
