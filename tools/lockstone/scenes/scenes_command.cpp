#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/scenes/scenes_page.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/output_file.h"
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

// In the order of the catalogue. None, with a complaint, if a name is unknown.
std::vector<scenes::SceneSummary> scenes_named(const std::vector<std::string>& names) {
  std::vector<scenes::SceneSummary> list = scenes::list_scenes();
  if (names.empty()) return list;
  for (const std::string& name : names) {
    if (std::ranges::find(list, name, &scenes::SceneSummary::name) != list.end()) continue;
    complain(fmt::format("no scene is named {}; `lockstone scenes` lists them", name));
    return {};
  }
  std::erase_if(
      list, [&](const auto& scene) { return std::ranges::find(names, scene.name) == names.end(); });
  return list;
}

}  // namespace

void add_scenes_command(CLI::App& app, int& exit_code) {
  struct Options {
    bool json = false;
    bool force = false;
    std::string page;
    std::vector<std::string> scenes;  // none: all
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("scenes", "List the built-in scenes");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_option("--page", options->page,
                      "Write a page with a picture of each scene instead: PAGE.md, PAGE/NAME.svg");
  command->add_option("--scene", options->scenes, "Only these");
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] {
    const std::vector<scenes::SceneSummary> list = scenes_named(options->scenes);
    if (list.empty()) {
      exit_code = k_usage;
      return;
    }
    exit_code = k_ok;
    if (!options->page.empty())
      exit_code = write_scenes_page(list, options->page, options->force) ? k_ok : k_unavailable;
    else
      options->json ? print_json(list) : print_table(list);
  });
}

}  // namespace lockstone::tool
