#include <memory>

#include <fmt/format.h>

#include "tools/bench/neutral/scene_json.h"
#include "tools/lockstone/bench/print/bench_front.h"
#include "tools/lockstone/commands.h"

namespace lockstone::tool {
namespace {

struct BenchScenesOptions {
  FrontOptions front;
  bool json = false;
  bool run = false;
};

void list_neutral_scenes() {
  for (const bench::NeutralScene& scene : bench::neutral_scenes())
    fmt::print("{:<16} {:>4} bodies {:>4} joints {:>5} s  {}\n", scene.name, scene.bodies.size(),
               scene.joints.size(), scene.seconds, scene.description);
}

int run(const BenchScenesOptions& options) {
  if (options.json) {
    fmt::print("{}\n", bench::scenes_to_json(bench::neutral_scenes()));
  } else if (options.run) {
    for (const bench::EngineRuns& engine : measure_front(options.front).engines) {
      for (const bench::Played& played : engine.runs)
        fmt::print("{}\n", bench::played_to_json(played));
    }
  } else {
    list_neutral_scenes();
  }
  return k_ok;
}

}  // namespace

void add_bench_scenes_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchScenesOptions>();
  CLI::App* command = bench.add_subcommand("scenes", "Scenes for any engine, and its results");
  command->add_flag("--json", options->json, "Print all scenes as JSON");
  command->add_flag("--run", options->run, "Play them: a line of JSON for each setting");
  add_front_options(*command, options->front);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
