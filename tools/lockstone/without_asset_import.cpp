// `lockstone asset build` in a build that cannot read other programs' files.
#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"

namespace lockstone::tool {

void add_asset_build_command(CLI::App& asset, int& exit_code) {
  CLI::App* command =
      asset.add_subcommand("build", "Not in this build: it has no import libraries");
  command->allow_extras();
  command->callback([&exit_code] {
    complain(
        "asset build: this build reads no files of other programs; install libpng-dev and "
        "libtinyobjloader-dev and configure anew (LOCKSTONE_WITH_ASSET_IMPORT)");
    exit_code = k_unavailable;
  });
}

}  // namespace lockstone::tool
