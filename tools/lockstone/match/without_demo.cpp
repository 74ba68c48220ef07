// The demo, in a build that has no network.
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/absent_command.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {

void add_demo_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "demo", "it has no network (LOCKSTONE_WITH_ENET is off)");
}

}  // namespace lockstone::tool
