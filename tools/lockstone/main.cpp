#include <fmt/format.h>

#include "tools/arena/arena_game.h"
#include "tools/arena/arena_simulation.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/render/svg.h"
#include "tools/scenes/play.h"
#include "tools/scenes/scenes_game.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

// Commands that need no game.
template <void (*Add)(CLI::App&, int&)>
void add_plain(CLI::App& app, Tool& tool) {
  Add(app, tool.exit_code);
}

std::string draw_built_in(const Simulation& simulation) {
  render::Picture picture;
  picture.caption = fmt::format("tick {}   {}", simulation.tick(), hash_text(simulation.hash()));
  picture.style = render::arena_look;
  return render::draw(*scenes::world_of(simulation), picture);
}

Games built_in_games() {
  std::vector<GameDef> games{arena::arena_game(), scenes::scenes_game()};
  for (GameDef& game : games) {
    game.build = "lockstone " LOCKSTONE_VERSION;
    game.draw = draw_built_in;
  }
  return Games(std::move(games));
}

// The commands for any game, and those that show and measure the library itself.
std::vector<CommandGroup> all_commands() {
  CommandGroup scenes = game_commands(), matches = match_commands(), logs = log_commands(),
               faults = fault_commands();
  scenes.commands.insert(scenes.commands.begin(), {add_plain<add_scenes_command>, add_run_command});
  scenes.commands.push_back(add_plain<add_numerics_command>);
  matches.commands.insert(matches.commands.begin(), add_demo_command);
  logs.commands.push_back(add_studio_command);
  faults.commands.insert(faults.commands.begin(), add_plain<add_bench_command>);
  faults.commands.push_back(add_plain<add_fuzz_pairs_command>);
  faults.commands.push_back(add_plain<add_fuzz_scene_command>);
  faults.commands.push_back(add_plain<add_fuzz_rollback_command>);
  faults.commands.push_back(add_plain<add_fuzz_vectors_command>);
  return {scenes, matches, logs, {"Assets", {add_plain<add_asset_command>}}, faults};
}

}  // namespace
}  // namespace lockstone::tool

int main(int argc, char** argv) {
  using namespace lockstone::tool;
  Tool tool{.games = built_in_games(), .simnet_scene = "toy"};
  return run_tool(argc, argv, tool,
                  {"lockstone", "Deterministic lockstep physics: scenes, matches and their logs.",
                   "lockstone " LOCKSTONE_VERSION},
                  all_commands());
}
