#include <csignal>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/fuzz/random_scene.h"
#include "tools/fuzz/scene_fuzz.h"
#include "tools/lockstone/bench/fuzz_options.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

struct FuzzSceneOptions {
  fuzz::SceneFuzzOptions run;
  bool json = false;
};

std::string reproducer(const FuzzSceneOptions& options, const fuzz::SceneFailure& failure) {
  return fmt::format("lockstone fuzz-scene --seed {} --first {} --count 1 --ticks {}",
                     options.run.seed, failure.index, options.run.ticks);
}

void print_text(const FuzzSceneOptions& options, const fuzz::SceneFuzzReport& report) {
  fmt::print("seed {}, {} scenes, {} ticks, {} failed\n", options.run.seed, report.scenes,
             report.ticks, report.failures.size());
  fmt::print("{} contacts, {} impacts, {} hits, {} saturations, {} ticks with an exhausted store\n",
             report.contacts, report.impacts, report.hits, report.saturations, report.exhausted);
  for (const fuzz::SceneFailure& failure : report.failures) {
    const fuzz::RandomScene scene(options.run.seed, failure.index);
    fmt::print("FAILED at tick {}: {} ({})\n  {}\n", failure.tick, failure.what, scene.text(),
               reproducer(options, failure));
  }
}

void print_json(const FuzzSceneOptions& options, const fuzz::SceneFuzzReport& report) {
  nlohmann::ordered_json document{{"seed", options.run.seed},
                                  {"scenes", report.scenes},
                                  {"ticks", report.ticks},
                                  {"contacts", report.contacts},
                                  {"impacts", report.impacts},
                                  {"hits", report.hits},
                                  {"saturations", report.saturations},
                                  {"exhausted", report.exhausted},
                                  {"failures", nlohmann::ordered_json::array()}};
  for (const fuzz::SceneFailure& failure : report.failures)
    document["failures"].push_back({{"index", failure.index},
                                    {"tick", failure.tick},
                                    {"what", failure.what},
                                    {"reproducer", reproducer(options, failure)}});
  write_json(document);
}

// A check that fails stops the program: say where it was. The calls here are not guaranteed to work
// in a handler; the program ends either way.
void name_scene_at_hand(int /*signal*/) {
  std::fprintf(stderr, "in scene %llu\n", static_cast<unsigned long long>(fuzz::scene_at_hand()));
}

int run(const FuzzSceneOptions& options) {
  std::signal(SIGABRT, name_scene_at_hand);
  const fuzz::SceneFuzzReport report = fuzz::fuzz_scenes(options.run);
  options.json ? print_json(options, report) : print_text(options, report);
  return report.failures.empty() ? k_ok : k_different;
}

}  // namespace

void add_fuzz_scene_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzSceneOptions>();
  CLI::App* command = app.add_subcommand(
      "fuzz-scene", "Random scenes, each run in two ways that must give the same states");
  add_fuzz_options(*command, options->run, options->json, "scenes");
  command->add_option("--ticks", options->run.ticks, "Ticks of each scene")->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
