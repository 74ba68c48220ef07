#include "tools/bench/rollback/wrong_guess.h"

#include <cmath>

#include <lockstone/rollback_history.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/bench/support/measure.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using arena::millimetres;

constexpr int k_islands = 40;
constexpr int k_rows = 5, k_columns = 4;  // of an island, a wall of bricks
constexpr double k_shares[] = {0, 0.01, 0.05, 0.2, 1};

// Walls that stand apart and do not sleep; body 0 is the ground.
World make_walls() {
  WorldDef def = speed_def(BroadPhaseKind::tree, 1024, 16384, 8192);
  def.sleep_ms = 0;
  World world = make_speed_world(def);
  scenes::add_ground(world, 100_m);
  BodyDef brick = scenes::loose(Shape::box(0.5_m, 0.25_m, 0.25_m), {});
  for (int island = 0; island < k_islands; ++island) {
    const int left = 10'000 * (island % 8) - 40'000, z = 10'000 * (island / 8) - 20'000;
    for (int i = 0; i < k_rows * k_columns; ++i) {
      const int row = i / k_columns, column = i % k_columns;
      const int x = left + 1010 * column + 500 * (row % 2);
      brick.position = {millimetres(x), millimetres(250 + 500 * row), millimetres(z)};
      scenes::add(world, brick);
    }
  }
  return world;
}

template <class F>
double microseconds(F&& f) {
  const std::uint64_t start = thread_nanoseconds();
  f();
  return static_cast<double>(thread_nanoseconds() - start) / 1e3;
}

// A world at the tick to go back to: something has just happened in every island, so that those
// which a guess touches cost no more than others.
class Match {
 public:
  explicit Match(const WrongGuessOptions& options)
      : options_(options),
        world_(make_walls()),
        history_(world_, static_cast<std::uint32_t>(options.ticks)) {
    for (int tick = 0; tick < options.settle; ++tick)
      world_.step();
    push(k_islands, 0.1_mps);
    world_.step();
    start_.resize(world_.snapshot_bytes_max(SnapshotKind::native));
    start_.resize(world_.save(SnapshotKind::native, start_));
    after_.resize(world_.snapshot_bytes_max(SnapshotKind::native));
  }

  void measure_state(WrongGuessReport& report) {
    report.islands = k_islands;
    report.bodies = world_.body_count() - 1;
    report.contacts = world_.record_hashes(StateStore::contacts, {});
    report.snapshot_bytes = start_.size();
    std::vector<double> loads, saves, hashes;
    for (int i = 0; i < options_.repeats; ++i) {
      for (int tick = 0; tick < options_.ticks; ++tick)
        world_.step();
      hashes.push_back(microseconds([&] { (void)world_.hash(); }));
      saves.push_back(microseconds([&] { (void)world_.save(SnapshotKind::native, after_); }));
      loads.push_back(microseconds([&] { go_back(); }));
    }
    report.load_us = quantile(loads, 0);
    report.save_us = quantile(saves, 0);
    report.hash_us = quantile(hashes, 0);
  }

  void measure_stages(WrongGuessReport& report) {
    world_.set_clock(now_nanoseconds);
    for (int tick = 0; tick < options_.ticks; ++tick)
      world_.step();
    for (std::size_t stage = 0; stage < k_step_stages; ++stage)
      report.stage_us[stage] =
          static_cast<double>(world_.profile().stage_ticks[stage]) / 1e3 / options_.ticks;
    world_.set_clock(nullptr);
    go_back();
  }

  [[nodiscard]] WrongGuess measure(double share) {
    WrongGuess result;
    result.share = share;
    result.touched = static_cast<std::uint32_t>(std::ceil(share * k_islands));
    std::vector<double> full, history;
    for (int i = 0; i < options_.repeats; ++i) {
      step_on_guess();
      go_back();
      push(result.touched, 0.12_mps);
      full.push_back(microseconds([&] {
        for (int tick = 0; tick < options_.ticks; ++tick)
          world_.step();
      }));
      result.hash = world_.hash().total;
      go_back();
      push(result.touched, 0.12_mps);
      history.push_back(microseconds([&] { step_by_history(result); }));
      result.are_equal = result.are_equal && world_.hash().total == result.hash;
      go_back();
    }
    result.full_us = quantile(full, 0);
    result.history_us = quantile(history, 0);
    return result;
  }

 private:
  void go_back() { (void)world_.load(SnapshotKind::native, start_); }

  // The guess is that nobody pushes; the history remembers that.
  void step_on_guess() {
    for (int tick = 0; tick < options_.ticks; ++tick)
      (void)history_.step();
  }

  void step_by_history(WrongGuess& result) {
    result.computed = result.recalled = 0;
    for (int tick = 0; tick < options_.ticks; ++tick) {
      const StepReport report = history_.step();
      result.computed += report.computed_islands;
      result.recalled += report.recalled_islands;
    }
  }

  // The last brick of each touched island, lightly.
  void push(std::uint32_t touched, Velocity speed) {
    for (std::uint32_t island = 0; island < touched; ++island) {
      const std::uint32_t brick = (island + 1) * k_rows * k_columns;
      scenes::order(world_, SetVelocity{world_.body_at(brick), {{}, {}, speed}});
    }
  }

  WrongGuessOptions options_;
  World world_;
  RollbackHistory history_;
  std::vector<std::byte> start_, after_;
};

}  // namespace

WrongGuessReport measure_wrong_guesses(const WrongGuessOptions& options) {
  WrongGuessReport report;
  Match match(options);
  match.measure_state(report);
  match.measure_stages(report);
  for (const double share : k_shares)
    report.guesses.push_back(match.measure(share));
  return report;
}

}  // namespace lockstone::bench
