#include "tools/lockstone/support/absent_command.h"

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {

void add_absent_command(CLI::App& parent, int& exit_code, const std::string& name,
                        const std::string& reason) {
  CLI::App* command = parent.add_subcommand(name, "Not in this build: " + reason);
  command->allow_extras();
  const std::string path =
      parent.get_parent() == nullptr ? name : fmt::format("{} {}", parent.get_name(), name);
  command->callback([path, reason, &exit_code] {
    complain(fmt::format("{}: not in this build: {}", path, reason));
    exit_code = k_unavailable;
  });
}

}  // namespace lockstone::tool
