#include "tools/bench/neutral/play.h"

#include <cmath>
#include <numeric>

#include "tools/bench/support/measure.h"

namespace lockstone::bench {
namespace {

constexpr double k_enough_seconds = 0.5;  // as tools/bench/peers/node/run.mjs

// The scene's commands before a tick.
void drive(NeutralEngine& engine, const NeutralScene& scene, int tick) {
  if (scene.tilt.size() > 1) engine.set_gravity(scene.gravity_at((tick + 1) / k_scene_tick_rate));
  for (const NeutralKick& kick : scene.kicks) {
    if (std::lround(kick.time * k_scene_tick_rate) == tick)
      engine.set_velocity(kick.body, kick.velocity);
  }
}

std::vector<BodyState> look(const NeutralEngine& engine, const NeutralScene& scene) {
  std::vector<BodyState> states;
  for (const int body : scene.watched)
    states.push_back(engine.state(body));
  return states;
}

}  // namespace

double Played::median_seconds() const {
  return median(cpu_seconds);
}

std::optional<Played> play(const NeutralMaker& maker, const NeutralScene& scene, int setting) {
  const std::unique_ptr<NeutralEngine> engine = maker.make(scene, setting);
  if (engine == nullptr) return std::nullopt;
  Played played{std::string(maker.name), scene.name, setting, {}, 0, {}, {}};
  const std::uint64_t begin = thread_nanoseconds();
  for (int tick = 0; tick < scene.ticks(); ++tick) {
    drive(*engine, scene, tick);
    engine->step();
    if ((tick + 1) % scene.record_every == 0) played.samples.push_back(look(*engine, scene));
  }
  const double taken = static_cast<double>(thread_nanoseconds() - begin) * 1e-9;
  if (taken > k_enough_seconds) played.cpu_seconds.push_back(taken / scene.seconds);
  played.hash = engine->hash();
  return played;
}

void time_again(const NeutralMaker& maker, const NeutralScene& scene, Played& played) {
  const std::vector<double>& before = played.cpu_seconds;
  const double sum = std::accumulate(before.begin(), before.end(), 0.0);
  if (sum * scene.seconds > k_enough_seconds) return;
  const std::unique_ptr<NeutralEngine> engine = maker.make(scene, played.setting);
  const std::uint64_t begin = thread_nanoseconds();
  for (int tick = 0; tick < scene.ticks(); ++tick) {
    drive(*engine, scene, tick);
    engine->step();
  }
  const auto taken = static_cast<double>(thread_nanoseconds() - begin);
  played.cpu_seconds.push_back(taken * 1e-9 / scene.seconds);
}

}  // namespace lockstone::bench
