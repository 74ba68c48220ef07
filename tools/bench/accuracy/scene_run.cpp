#include "tools/bench/accuracy/scene_run.h"

#include <array>
#include <cmath>
#include <utility>

#include "tools/bench/support/measure.h"

namespace lockstone::bench {
namespace {

WorldDef with(const Setting& setting, WorldDef def) {
  def.tick_rate = setting.tick_rate;
  def.substeps = setting.substeps;
  return def;
}

}  // namespace

std::string Setting::name() const {
  return std::to_string(tick_rate) + " Hz x " + std::to_string(substeps);
}

SceneRun::SceneRun(const Setting& setting, WorldDef def, std::shared_ptr<const AssetSet> assets)
    : setting_(setting),
      world_(std::move(World::create(with(setting, def), std::move(assets)).value())) {}

BodyHandle SceneRun::add(const BodyDef& def) {
  return world_.create_body(def).value();
}

void SceneRun::step() {
  const std::uint64_t start = thread_nanoseconds();
  (void)world_.step();
  nanoseconds_ += thread_nanoseconds() - start;
  ++ticks_;
}

void SceneRun::run(double seconds) {
  for (auto left = std::llround(seconds * setting_.tick_rate); left > 0; --left)
    step();
}

AccuracyResult SceneRun::result(std::string name, std::string unit, double worst,
                                double goal) const {
  AccuracyResult result{std::move(name), std::move(unit), 1, worst, goal, {}};
  result.tick_seconds =
      ticks_ == 0 ? 0 : static_cast<double>(nanoseconds_) * 1e-9 / static_cast<double>(ticks_);
  result.hash = world_.hash().total;
  result.setting = setting_.name();
  result.judged = setting_ == k_usual_setting;
  return result;
}

std::vector<AccuracyResult> over_substeps(
    const std::function<AccuracyResult(const Setting&)>& measure) {
  std::vector<AccuracyResult> results;
  for (const std::uint8_t substeps : std::array<std::uint8_t, 5>{1, 2, 4, 8, 16})
    results.push_back(measure({60, substeps}));
  return results;
}

std::vector<AccuracyResult> over_tick_rates(
    const std::function<AccuracyResult(const Setting&)>& measure) {
  std::vector<AccuracyResult> results;
  for (const std::uint16_t rate : std::array<std::uint16_t, 4>{30, 60, 120, 240})
    results.push_back(measure({rate, k_usual_setting.substeps}));
  return results;
}

}  // namespace lockstone::bench
