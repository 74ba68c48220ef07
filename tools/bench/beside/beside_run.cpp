#include "tools/bench/beside/beside_run.h"

#include <algorithm>
#include <numeric>

namespace lockstone::bench {
namespace {

constexpr int k_turn = 10;  // ticks

// One engine in one pass through the scene.
struct Player {
  std::unique_ptr<GeneralEngine> engine;
  std::vector<double> ticks;
};

class Pass {
 public:
  Pass(const GeneralScene& scene, const BesideOptions& options)
      : scene_(scene), clock_(options.clock), changes_(changes_of(scene)), moves_(changes_.size()) {
    for (const GeneralMove& move : scene.moves)
      moves_[static_cast<std::size_t>(move.tick)].push_back(&move);
    for (const BesideEngine& engine : options.engines)
      players.push_back({engine.maker.make(scene, engine.substeps), {}});
  }

  void play() {
    for (int first = 0; first < scene_.ticks; first += k_turn) {
      for (Player& player : players)
        if (player.engine != nullptr) turn(player, first, std::min(first + k_turn, scene_.ticks));
    }
  }

  std::vector<Player> players;

 private:
  void turn(Player& player, int first, int end) {
    for (int tick = first; tick < end; ++tick) {
      const auto i = static_cast<std::size_t>(tick);
      if (tick > 0) player.engine->change(changes_[i]);
      for (const GeneralMove* move : moves_[i])
        player.engine->set_motion(move->body, move->velocity, move->angular_velocity);
      const std::uint64_t begin = clock_();
      player.engine->step();
      player.ticks.push_back(static_cast<double>(clock_() - begin));
    }
  }

  const GeneralScene& scene_;
  Clock clock_;
  std::vector<GeneralChange> changes_;                  // by tick
  std::vector<std::vector<const GeneralMove*>> moves_;  // by tick
};

void look_at_end(const GeneralScene& scene, const GeneralEngine& engine, BesideFigures& figures) {
  double bodies = 0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const GeneralBody& body = scene.bodies[i];
    if (!body.moves() || body.from >= scene.ticks || body.until < scene.ticks) continue;
    const int index = static_cast<int>(i);
    figures.height += engine.state(index).position[1];
    figures.asleep += engine.asleep(index) ? 1 : 0;
    bodies += 1;
  }
  figures.height /= std::max(bodies, 1.0);
  figures.asleep /= std::max(bodies, 1.0);
  figures.had_room = engine.had_room();
}

std::vector<double> medians_of(const std::vector<std::vector<double>>& passes) {
  std::vector<double> medians;
  for (std::size_t tick = 0; tick < passes.front().size(); ++tick) {
    std::vector<double> values;
    for (const std::vector<double>& pass : passes)
      values.push_back(pass[tick]);
    medians.push_back(median(std::move(values)));
  }
  return medians;
}

}  // namespace

double BesideFigures::mean() const {
  return std::accumulate(ticks.begin(), ticks.end(), 0.0) / static_cast<double>(ticks.size());
}

double BesideFigures::quantile_of(double share) const {
  return quantile(ticks, share);
}

BesideRun play_beside(const GeneralScene& scene, const BesideOptions& options) {
  BesideRun run{scene.family, 0, scene.joints.size(), scene.ticks, {}, {}};
  run.bodies = static_cast<std::size_t>(std::ranges::count_if(scene.bodies, &GeneralBody::moves));
  std::vector<std::vector<std::vector<double>>> ticks(options.engines.size());  // engine, pass
  for (const BesideEngine& engine : options.engines)
    run.figures.push_back({engine.name, false, {}, 0, 0, true});
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    Pass pass(scene, options);
    pass.play();
    for (std::size_t i = 0; i < pass.players.size(); ++i) {
      Player& player = pass.players[i];
      run.figures[i].played = player.engine != nullptr;
      if (player.engine == nullptr) continue;
      ticks[i].push_back(std::move(player.ticks));
      if (repeat == 0) look_at_end(scene, *player.engine, run.figures[i]);
    }
  }
  for (std::size_t i = 0; i < run.figures.size(); ++i)
    if (run.figures[i].played) run.figures[i].ticks = medians_of(ticks[i]);
  return run;
}

}  // namespace lockstone::bench
