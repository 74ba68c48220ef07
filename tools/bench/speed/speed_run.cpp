#include "tools/bench/speed/speed_run.h"

#include <algorithm>
#include <numeric>

#include <lockstone/thread_pool.h>

namespace lockstone::bench {
namespace {

// One pass through the scene.
struct Pass {
  std::vector<TickTimes> times;
  std::vector<StepReport> reports;
  double hash_nanoseconds = 0;
  std::uint64_t hash = 0;
  std::uint32_t bodies = 0;
};

void drive(const SpeedScene& scene, World& world) {
  if (scene.drive != nullptr) scene.drive(world);
}

// A function of its own, so that the counter of instructions finds it (instructions.cpp): scenes
// step while they are made, too.
[[gnu::noinline]] StepReport measured_step(World& world) {
  return world.step();
}

// Setting the clock begins a new profile, so each tick has its own.
TickTimes time_tick(const SpeedScene& scene, World& world, Clock clock, StepReport& report) {
  world.set_clock(clock);
  const std::uint64_t begin = clock();
  drive(scene, world);
  report = measured_step(world);
  TickTimes times;
  times.whole = static_cast<double>(clock() - begin);
  for (std::size_t i = 0; i < k_step_stages; ++i)
    times.stages[i] = static_cast<double>(world.profile().stage_ticks[i]);
  return times;
}

double time_hash(const World& world, Clock clock, std::uint64_t& hash) {
  constexpr int k_repeats = 11;
  std::vector<double> times;
  for (int i = 0; i < k_repeats; ++i) {
    const std::uint64_t begin = clock();
    hash = world.hash().total;
    times.push_back(static_cast<double>(clock() - begin));
  }
  return median(std::move(times));
}

Pass run_pass(const SpeedScene& scene, const SpeedOptions& options, std::uint32_t ticks,
              std::uint32_t threads) {
  Pass pass;
  ThreadPool pool(threads);
  World world = scene.make(options.broad_phase);
  if (threads > 1) world.set_task_runner(&pool);
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    pass.times.push_back(time_tick(scene, world, options.clock, pass.reports.emplace_back()));
  }
  pass.hash_nanoseconds = time_hash(world, options.clock, pass.hash);
  pass.bodies = world.body_count();
  return pass;
}

// Of one figure of one tick, over the passes.
template <class Figure>
double median_of(const std::vector<Pass>& passes, Figure&& figure) {
  std::vector<double> values;
  for (const Pass& pass : passes)
    values.push_back(figure(pass));
  return median(std::move(values));
}

TickTimes median_tick(const std::vector<Pass>& passes, std::size_t tick) {
  TickTimes times;
  times.whole = median_of(passes, [&](const Pass& pass) { return pass.times[tick].whole; });
  for (std::size_t i = 0; i < k_step_stages; ++i) {
    times.stages[i] =
        median_of(passes, [&](const Pass& pass) { return pass.times[tick].stages[i]; });
  }
  return times;
}

StepProfile run_in_detail(const SpeedScene& scene, const SpeedOptions& options, std::uint32_t ticks,
                          std::uint64_t& hash) {
  World world = scene.make(options.broad_phase);
  world.set_clock(options.clock, ProfileDetail::pairs);
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    drive(scene, world);
    (void)world.step();
  }
  hash = world.hash().total;
  return world.profile();
}

SpeedResult result_of(const SpeedScene& scene, const std::vector<Pass>& passes,
                      std::uint32_t ticks) {
  SpeedResult result;
  result.scene = &scene;
  result.bodies = passes.front().bodies;
  result.reports = passes.front().reports;
  result.hash = passes.front().hash;
  result.hash_nanoseconds =
      median_of(passes, [](const Pass& pass) { return pass.hash_nanoseconds; });
  for (std::size_t tick = 0; tick < ticks; ++tick)
    result.times.push_back(median_tick(passes, tick));
  for (const Pass& pass : passes)
    result.hashes_agree = result.hashes_agree && pass.hash == result.hash;
  return result;
}

}  // namespace

Status SpeedResult::status() const {
  const auto failed = std::ranges::find_if(
      reports, [](const StepReport& report) { return report.status != Status::ok; });
  return failed == reports.end() ? Status::ok : failed->status;
}

double SpeedResult::quantile_of_ticks(double share) const {
  std::vector<double> values;
  for (const TickTimes& tick : times)
    values.push_back(tick.whole);
  return quantile(std::move(values), share);
}

double SpeedResult::sum_of_ticks() const {
  return std::accumulate(times.begin(), times.end(), 0.0,
                         [](double sum, const TickTimes& tick) { return sum + tick.whole; });
}

double SpeedResult::sum_of(StepStage stage) const {
  const auto index = static_cast<std::size_t>(stage);
  return std::accumulate(times.begin(), times.end(), 0.0, [&](double sum, const TickTimes& tick) {
    return sum + tick.stages[index];
  });
}

std::uint64_t SpeedResult::sum(std::uint32_t StepReport::*counter) const {
  std::uint64_t sum = 0;
  for (const StepReport& report : reports)
    sum += report.*counter;
  return sum;
}

std::vector<SpeedResult> run_speed(const SpeedScene& scene, const SpeedOptions& options) {
  const std::uint32_t ticks = options.ticks != 0 ? options.ticks : scene.ticks;
  std::vector<std::vector<Pass>> passes(options.threads.size());
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (std::size_t i = 0; i < passes.size(); ++i)
      passes[i].push_back(run_pass(scene, options, ticks, options.threads[i]));
  }
  std::vector<SpeedResult> results;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    results.push_back(result_of(scene, passes[i], ticks));
    results.back().threads = options.threads[i];
    results.back().hashes_agree &= results.back().hash == results.front().hash;
  }
  if (!options.detail) return results;
  SpeedResult& first = results.front();
  std::uint64_t hash = 0;
  first.detail = run_in_detail(scene, options, ticks, hash);
  first.hashes_agree = first.hashes_agree && hash == first.hash;
  return results;
}

}  // namespace lockstone::bench
