// Row 24: distances, shape casts and rays, proven in double by planes and witnesses.
#include <array>
#include <mutex>

#include "tools/bench/accuracy/accuracy.h"
#include "tools/fuzz/fuzz_run.h"
#include "tools/fuzz/pair_checks.h"
#include "tools/support/for_blocks.h"

namespace lockstone::bench {
namespace {

using fuzz::Check;
using fuzz::Figure;
using fuzz::norm;
using fuzz::real;

constexpr double k_goal = 2e-6;
constexpr double k_near = 20;  // m: the usual distances within one room of a game

using Figures = std::array<Figure, fuzz::k_checks>;

void add(const Figures& part, Figures& sum) {
  for (std::size_t i = 0; i < sum.size(); ++i)
    sum[i].add(part[i]);
}

// Merged faces differ from their vertices, so that two truths are known of such hulls: left out.
bool has_one_truth(const fuzz::Pair& pair) {
  return uneven_slack(pair) < 1e-7;
}

bool is_near(const fuzz::Pair& pair) {
  const double cast = norm(real(pair.cast_from)) + norm(real(pair.way));
  const double ray = norm(real(pair.ray_origin)) + norm(real(pair.ray_way));
  return std::max({pair.size(), cast, ray}) < k_near;
}

void add_results(const char* where, const Figures& figures, std::vector<AccuracyResult>& results) {
  const auto figure = [&](Check check) { return figures[static_cast<std::size_t>(check)]; };
  const auto line = [&](const char* what, const char* unit, std::uint64_t tries, double worst,
                        double goal) {
    results.push_back({std::string(what) + where, unit, tries, worst, goal, {}});
  };
  const Figure distance = figure(Check::distance), cast = figure(Check::cast),
               ray = figure(Check::ray);
  const Figure cast_miss = figure(Check::cast_miss), ray_miss = figure(Check::ray_miss);
  line("distances", "m", distance.count, distance.worst, k_goal);
  line("shape casts", "m", cast.count, cast.worst, k_goal);
  line("shape casts", "wrong", cast.count + cast_miss.count,
       static_cast<double>(cast.failures + cast_miss.failures), 0);
  line("rays", "m", ray.count, ray.worst, k_goal);
  line("rays", "wrong", ray.count + ray_miss.count,
       static_cast<double>(ray.failures + ray_miss.failures), 0);
}

}  // namespace

std::vector<AccuracyResult> measure_queries(const AccuracyOptions& options) {
  fuzz::HullPool pool(options.seed);
  using fuzz::Kind;
  // Rims have bounds of their own: see `fuzz-pairs`.
  const std::vector<Kind> kinds{Kind::sphere, Kind::capsule,  Kind::box,
                                Kind::hull,   Kind::triangle, Kind::half_space};
  std::mutex mutex;
  Figures near{}, far{};
  tool::for_blocks(
      options.tries, 1024, options.threads, [&](std::uint64_t first, std::uint64_t count) {
        Figures near_part{}, far_part{};
        for (std::uint64_t i = options.first + first; i < options.first + first + count; ++i) {
          const fuzz::Pair pair = make_pair(pool, options.seed, i, kinds);
          if (!has_one_truth(pair)) continue;
          fuzz::Verdict verdict(i);
          check_distance(pair, fuzz::Answers(pair), verdict);
          check_cast(pair, verdict);
          check_ray(pair, verdict);
          add(verdict.figures(), is_near(pair) ? near_part : far_part);
        }
        const std::lock_guard lock(mutex);
        add(near_part, near);
        add(far_part, far);
      });
  std::vector<AccuracyResult> results;
  add_results(" within 20 m", near, results);
  add_results(" to 2000 m", far, results);
  return results;
}

}  // namespace lockstone::bench
