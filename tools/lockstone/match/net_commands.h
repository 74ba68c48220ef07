// The subcommands that play over a network or try one; as commands.h.
#pragma once

namespace CLI {
class App;
}

namespace lockstone::tool {

struct Tool;

void add_serve_command(CLI::App& app, Tool& tool);
void add_join_command(CLI::App& app, Tool& tool);
void add_token_command(CLI::App& app, Tool& tool);
void add_simnet_command(CLI::App& app, Tool& tool);
void add_lossy_command(CLI::App& app, Tool& tool);
void add_siege_command(CLI::App& app, Tool& tool);

}  // namespace lockstone::tool
