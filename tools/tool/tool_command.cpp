#include "tools/tool/tool_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/match/net_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/suggestion.h"
#include "tools/tool/game_loader.h"

namespace lockstone::tool {
namespace {

// Loads a game at once, so that the command finds it.
void add_game_option(CLI::App& app, Tool& tool) {
  const auto load = [&tool](const std::string& path) {
    std::string why;
    Result<GameDef> game = load_game(path, why);
    if (!game) {
      complain("--game " + path + ": " + why);
      const bool is_foreign = game.status() != Status::io_error;
      throw CLI::RuntimeError(is_foreign ? k_incompatible : k_unavailable);
    }
    tool.games.add_front(std::move(game).value());
    tool.simnet_scene.clear();
  };
  app.add_option_function<std::string>(
      "--game", load,
      "A game in a shared library, which exports lockstone_game; before the command");
}

constexpr const char* k_footer =
    "Exit codes: 0 ok, 1 states differ, 2 damaged or unreadable input, 3 incompatible,\n"
    "64 wrong usage, 69 the network or the system refused.";

void add_group(CLI::App& app, Tool& tool, const CommandGroup& group) {
  for (const AddCommand add : group.commands) {
    add(app, tool);
    app.get_subcommands({}).back()->group(group.title)->footer(k_footer);
  }
}

// "sumo" of "/opt/bin/sumo.exe".
std::string name_of_file(const char* path) {
  std::string name = path == nullptr ? "game" : path;
  name = name.substr(name.find_last_of("/\\") + 1);
  if (name.size() > 4 && name.ends_with(".exe")) name.resize(name.size() - 4);
  return name.empty() ? "game" : name;
}

}  // namespace

CommandGroup game_commands() {
  return {"Scenes",
          {add_flips_command, add_sync_test_command, add_hash_command, add_compare_hashes_command}};
}

CommandGroup match_commands() {
  return {"Matches", {add_serve_command, add_join_command, add_token_command}};
}

CommandGroup log_commands() {
  return {"Logs",
          {add_record_command, add_info_command, add_verify_command, add_seek_command,
           add_trace_command, add_diff_command, add_bisect_command, add_repair_command,
           add_cut_command, add_keygen_command}};
}

CommandGroup fault_commands() {
  return {"Measuring, and looking for faults",
          {add_simnet_command, add_lossy_command, add_siege_command}};
}

int run_tool(int argc, char** argv, Tool& tool, const ToolText& text,
             const std::vector<CommandGroup>& groups) {
  set_program_name(text.program);
  CLI::App app(text.description, text.program);
  app.set_version_flag("--version", text.version);
  app.allow_windows_style_options(false);  // "/" begins a path
  app.require_subcommand(1);
  app.footer(k_footer);
  add_game_option(app, tool);
  for (const CommandGroup& group : groups)
    add_group(app, tool, group);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_argument(app);
    if (unknown.empty()) return app.exit(error) == 0 ? k_ok : k_usage;
    complain(unknown + "\nRun with --help for more information.");
    return k_usage;
  }
  return tool.exit_code;
}

}  // namespace lockstone::tool

namespace lockstone {

int tool_main(int argc, char** argv, std::span<const GameDef> games) {
  using namespace tool;
  for (const GameDef& game : games) {
    if (game.make && !game.name.empty() && game.name.size() <= replay::k_max_game_bytes) continue;
    complain("a GameDef needs `make`, and a `name` of 1 … 64 bytes");
    return k_usage;
  }
  if (games.empty()) return k_usage;
  Tool tool{.games = Games({games.begin(), games.end()}), .simnet_scene = {}};
  const GameDef& first = games.front();
  return run_tool(argc, argv, tool,
                  {first.name, "Matches of " + first.name + " and their logs.",
                   build_of(first) + " (lockstone " LOCKSTONE_VERSION ")"},
                  {match_commands(), log_commands(), game_commands(), fault_commands()});
}

int tool_main(int argc, char** argv, const GameDef& game) {
  return tool_main(argc, argv, std::span(&game, 1));
}

int tool_main(int argc, char** argv, const SimulationFactory& make) {
  GameDef game;
  game.name = tool::name_of_file(argc > 0 ? argv[0] : nullptr);
  game.make = make;
  return tool_main(argc, argv, game);
}

}  // namespace lockstone

int lockstone_tool_main(int argc, char** argv, const lockstone_game_table* table) {
  using namespace lockstone;
  std::string why;
  const Result<GameDef> game = tool::game_of_table(table, why);
  if (game) return tool_main(argc, argv, game.value());
  tool::complain(why);
  return tool::k_incompatible;
}
