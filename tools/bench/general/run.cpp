#include "tools/bench/general/run.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "tools/bench/support/measure.h"

namespace lockstone::bench {

int FamilyRun::failures() const {
  return static_cast<int>(std::ranges::count_if(
      figures, [](const auto& figure) { return figure.has_value() && figure->failed; }));
}

double FamilyRun::quantile_of(double GeneralFigures::*figure, double share) const {
  std::vector<double> values;
  for (const auto& seed : figures)
    if (seed.has_value()) values.push_back((*seed).*figure);
  return quantile(std::move(values), share);
}

std::vector<FamilyRun> run_general(const GeneralOptions& options,
                                   void (*progress)(int done, int total)) {
  std::vector<FamilyRun> runs;
  const auto seeds = static_cast<std::size_t>(options.seeds);
  for (const Family* family : options.families) {
    for (const GeneralMaker& engine : options.engines) {
      runs.push_back({family, std::string(engine.name), {}});
      runs.back().figures.resize(seeds);
    }
  }
  const std::size_t engines = options.engines.size(), total = runs.size() * seeds;
  std::atomic<std::size_t> next{0};
  std::mutex guard;
  int done = 0;
  const auto work = [&] {
    for (std::size_t job = next++; job < total; job = next++) {
      FamilyRun& run = runs[job / seeds];
      const GeneralScene scene = make_scene(*run.family, options.first_seed + job % seeds);
      run.figures[job % seeds] =
          play_general(options.engines[job / seeds % engines], scene, options.substeps);
      const std::scoped_lock lock(guard);
      if (progress != nullptr) progress(++done, static_cast<int>(total));
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < options.threads; ++i)
    threads.emplace_back(work);
  work();
  for (std::thread& thread : threads)
    thread.join();
  return runs;
}

int shrink_general(const GeneralMaker& maker, const Family& family, std::uint64_t seed,
                   int substeps) {
  const auto fails = [&](int cap) {
    const auto figures = play_general(maker, make_scene(family, seed, cap), substeps);
    return figures.has_value() && figures->failed;
  };
  if (!fails(k_no_cap)) return k_no_cap;
  const int most = static_cast<int>(make_scene(family, seed).bodies.size());
  for (int cap = 1; cap < most; cap += 1 + cap / 8) {
    if (fails(cap)) return cap;
  }
  return most;
}

}  // namespace lockstone::bench
