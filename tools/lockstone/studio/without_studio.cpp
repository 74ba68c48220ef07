// The studio, in a build without its page.
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/absent_command.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {

bool has_studio() {
  return false;
}

void add_studio_command(CLI::App& app, Tool& tool) {
  add_absent_command(app, tool.exit_code, "studio",
                     "its page was not there. Run `tools/studio.sh build`, which builds the page "
                     "and then this command with it");
}

}  // namespace lockstone::tool
