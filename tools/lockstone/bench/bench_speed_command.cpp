#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tools/bench/support/measure.h"
#include "tools/lockstone/bench/bench_beside.h"
#include "tools/lockstone/bench/print/bench_instructions.h"
#include "tools/lockstone/bench/print/bench_speed_print.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/options.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

struct BenchSpeedOptions {
  std::vector<std::string> scenes;  // none: all
  std::uint32_t ticks = 0;
  int repeats = 0;                     // 0: by `quick`
  std::vector<std::uint32_t> threads;  // none: 1, and all that the machine runs at once
  BroadPhaseKind broad_phase = BroadPhaseKind::tree;
  bool cpu = false;
  bool quick = false;
  bool detail = false;
  bool json = false;
  std::string csv;
  std::string instructions;  // a file to write; empty: times instead
  std::string compare;       // a file that `instructions` wrote
  bool force = false;
  std::string vectors;  // empty: the widest
  BesideRequest beside;
};

// Empty when a name is unknown.
std::vector<const bench::SpeedScene*> chosen_scenes(const std::vector<std::string>& names) {
  const auto all = bench::speed_scenes();
  if (names.empty()) return {all.begin(), all.end()};
  std::vector<const bench::SpeedScene*> chosen;
  for (const std::string& name : names) {
    const bench::SpeedScene* scene = bench::find_speed_scene(name);
    if (scene != nullptr) {
      chosen.push_back(scene);
      continue;
    }
    complain(fmt::format("no scene is named {}; --list names them", name));
    return {};
  }
  return chosen;
}

std::vector<std::uint32_t> threads_of(const BenchSpeedOptions& options) {
  if (!options.threads.empty()) return options.threads;
  const std::uint32_t all = std::clamp(std::thread::hardware_concurrency(), 1U, k_max_workers);
  if (options.cpu || all == 1) return {1};
  return {1, all};
}

int repeats_of(const BenchSpeedOptions& options) {
  return options.repeats != 0 ? options.repeats : options.quick ? 1 : 3;
}

bench::SpeedOptions measure_of(const BenchSpeedOptions& options, const bench::SpeedScene& scene) {
  bench::SpeedOptions measure;
  measure.detail = options.detail;
  measure.threads = threads_of(options);
  measure.broad_phase = options.broad_phase;
  if (options.cpu) measure.clock = bench::thread_nanoseconds;
  measure.repeats = repeats_of(options);
  measure.ticks = options.ticks;
  if (options.ticks == 0 && options.quick) measure.ticks = std::max(scene.ticks / 5, 1U);
  return measure;
}

void list_scenes(const std::vector<const bench::SpeedScene*>& scenes) {
  for (const bench::SpeedScene* scene : scenes) {
    fmt::print("{:<14} {:>5} ticks  {}\n", scene->name, scene->ticks, scene->description);
  }
}

SpeedReport measure(const BenchSpeedOptions& options,
                    const std::vector<const bench::SpeedScene*>& scenes) {
  SpeedReport report;
  report.detail = options.detail;
  report.clock_name = options.cpu ? "thread" : "steady";
  report.clock_nanoseconds =
      bench::clock_overhead(options.cpu ? bench::thread_nanoseconds : bench::now_nanoseconds);
  Progress progress;
  for (const bench::SpeedScene* scene : scenes) {
    progress.show(std::string(scene->name));
    std::ranges::move(bench::run_speed(*scene, measure_of(options, *scene)),
                      std::back_inserter(report.results));
  }
  return report;
}

// A faster wrong answer must not pass for a good one.
int verdict(const SpeedReport& report) {
  int code = k_ok;
  for (const bench::SpeedResult& result : report.results) {
    if (result.status() == Status::ok && result.hashes_agree) continue;
    complain(fmt::format("{}: {}", result.scene->name,
                         result.hashes_agree ? "a tick did not do all of its work"
                                             : "repeats ended in different states"));
    code = k_different;
  }
  return code;
}

int run_beside(const BenchSpeedOptions& options,
               const std::vector<const bench::SpeedScene*>& scenes) {
  BesideRequest request = options.beside;
  request.only = options.scenes;
  request.ticks = options.ticks;
  request.repeats = repeats_of(options);
  request.cpu = options.cpu;
  request.json = options.json;
  request.force = options.force;
  request.vectors = options.vectors;
  return bench_beside(request, scenes);
}

int run(const BenchSpeedOptions& options, bool list) {
  const std::vector<const bench::SpeedScene*> scenes = chosen_scenes(options.scenes);
  if (scenes.empty()) return k_usage;
  if (list) {
    list_scenes(scenes);
    return k_ok;
  }
  if (!use_vectors(options.vectors)) return k_usage;
  if (options.beside.wanted()) return run_beside(options, scenes);
  const Output csv{options.csv, options.force}, counts{options.instructions, options.force};
  if (!may_write(csv) || !may_write(counts)) return k_unavailable;
  if (!options.compare.empty()) return compare_instructions(options.compare);
  if (!options.instructions.empty()) return write_instructions(scenes, options.ticks, counts);
  const SpeedReport report = measure(options, scenes);
  options.json ? print_speed_json(report) : print_speed_tables(report);
  if (!options.csv.empty() && !write_text_file(csv, speed_csv(report))) return k_unavailable;
  return verdict(report);
}

}  // namespace

void add_bench_speed_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchSpeedOptions>();
  auto list = std::make_shared<bool>(false);
  CLI::App* command = bench.add_subcommand("speed", "Time per tick of large scenes, by stage");
  command->add_option("--scene", options->scenes, "Only these");
  command->add_option("--ticks", options->ticks, "Instead of the scene's own number")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--repeats", options->repeats, "A tick's time is the median over these (3)")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--threads", options->threads,
                   "Numbers of threads to compare (1 and all; with --cpu 1)")
      ->check(CLI::Range(1U, k_max_workers));
  add_broad_phase_option(*command, options->broad_phase);
  add_vectors_option(*command, options->vectors);
  command->add_flag("--cpu", options->cpu,
                    "Count only the time that the stepping thread itself ran");
  command->add_flag("--quick", options->quick, "Run a fifth of the ticks, once");
  command->add_flag("--detail", options->detail, "Also a table of pairs by kinds of shape");
  command->add_flag("--list", *list, "Only name the scenes");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_option("--csv", options->csv, "Write a file with one line a tick");
  command->add_option("--instructions", options->instructions,
                      "Instead: count instructions by callgrind into this file");
  command->add_option("--compare", options->compare,
                      "Instead: count the scenes of such a file again; exit code 1 above 2 % more");
  add_force_option(*command, options->force);
  add_beside_options(*command, options->beside);
  command->callback([options, list, &exit_code] { exit_code = run(*options, *list); });
}

}  // namespace lockstone::tool
