// The subcommands that need a network, in a build that has none.
#include "tools/lockstone/match/net_commands.h"
#include "tools/lockstone/support/absent_command.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {

static constexpr const char* k_no_network = "it has no network (LOCKSTONE_WITH_ENET is off)";

void add_serve_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "serve", k_no_network);
}
void add_join_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "join", k_no_network);
}
void add_token_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "token", k_no_network);
}
void add_lossy_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "lossy", k_no_network);
}
void add_siege_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "siege", k_no_network);
}

}  // namespace lockstone::tool
