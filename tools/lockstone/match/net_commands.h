// The subcommands that try the network; as commands.h.
#pragma once

#include <CLI/App.hpp>

namespace lockstone::tool {

void add_lossy_command(CLI::App& app, int& exit_code);
void add_siege_command(CLI::App& app, int& exit_code);

}  // namespace lockstone::tool
