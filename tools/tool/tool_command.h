// The command line around the commands: games, exit code, groups.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>

#include "tools/lockstone/commands.h"
#include "tools/tool/games.h"

namespace lockstone::tool {

/// The state that all commands of one run share.
struct Tool {
  Games games;
  std::string simnet_scene;  ///< the default of `simnet`; empty: the first game
  int exit_code = k_ok;
};

using AddCommand = void (*)(CLI::App& app, Tool& tool);

/// Commands under a title of their own in the help.
struct CommandGroup {
  const char* title;
  std::vector<AddCommand> commands;
};

/// Names, and the first lines of the help.
struct ToolText {
  std::string program;
  std::string description;
  std::string version;
};

/// The commands for any game.
[[nodiscard]] CommandGroup game_commands();
[[nodiscard]] CommandGroup match_commands();
[[nodiscard]] CommandGroup log_commands();
[[nodiscard]] CommandGroup fault_commands();

/// Parses the arguments, runs the command, and returns the exit code.
[[nodiscard]] int run_tool(int argc, char** argv, Tool& tool, const ToolText& text,
                           const std::vector<CommandGroup>& groups);

}  // namespace lockstone::tool
