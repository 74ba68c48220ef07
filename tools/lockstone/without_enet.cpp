// The subcommands that need a network, in a build that has none.
#include <cstdio>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"
#include "tools/lockstone/net_commands.h"

namespace lockstone::tool {
namespace {

void add_absent(CLI::App& app, int& exit_code, const char* name) {
  CLI::App* command = app.add_subcommand(name, "Not in this build: it has no ENet");
  command->allow_extras();
  command->callback([name, &exit_code] {
    complain(fmt::format("{}: this build has no network (LOCKSTONE_WITH_ENET is off)", name));
    exit_code = k_unavailable;
  });
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  add_absent(app, exit_code, "serve");
}
void add_join_command(CLI::App& app, int& exit_code) {
  add_absent(app, exit_code, "join");
}
void add_token_command(CLI::App& app, int& exit_code) {
  add_absent(app, exit_code, "token");
}
void add_lossy_command(CLI::App& app, int& exit_code) {
  add_absent(app, exit_code, "lossy");
}
void add_siege_command(CLI::App& app, int& exit_code) {
  add_absent(app, exit_code, "siege");
}
void add_demo_command(CLI::App& app, int& exit_code) {
  add_absent(app, exit_code, "demo");
}

}  // namespace lockstone::tool
