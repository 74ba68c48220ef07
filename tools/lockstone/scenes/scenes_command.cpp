#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/scenes/play.h"

namespace lockstone::tool {
namespace {

void print_json(const std::vector<scenes::SceneSummary>& list) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const scenes::SceneSummary& scene : list) {
    json.push_back({{"name", scene.name},
                    {"description", scene.description},
                    {"golden_ticks", scene.golden_ticks},
                    {"bodies", scenes::count_bodies(scene)}});
  }
  write_json(json);
}

void print_table(const std::vector<scenes::SceneSummary>& list) {
  fmt::print("{:<10} {:>6} {:>6}  {}\n", "scene", "bodies", "ticks", "");
  for (const scenes::SceneSummary& scene : list) {
    fmt::print("{:<10} {:>6} {:>6}  {}\n", scene.name, scenes::count_bodies(scene),
               scene.golden_ticks, scene.description);
  }
}

}  // namespace

void add_scenes_command(CLI::App& app, int& exit_code) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("scenes", "List the built-in scenes");
  command->add_flag("--json", *json, "Print JSON");
  command->callback([json, &exit_code] {
    const std::vector<scenes::SceneSummary> list = scenes::list_scenes();
    *json ? print_json(list) : print_table(list);
    exit_code = k_ok;
  });
}

}  // namespace lockstone::tool
