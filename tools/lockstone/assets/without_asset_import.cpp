// `lockstone asset build` in a build that cannot read other programs' files.
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/absent_command.h"

namespace lockstone::tool {

void add_asset_build_command(CLI::App& asset, int& exit_code) {
  add_absent_command(asset, exit_code, "build",
                     "it has no import libraries; install libpng-dev and libtinyobjloader-dev and "
                     "configure again (LOCKSTONE_WITH_ASSET_IMPORT)");
}

}  // namespace lockstone::tool
