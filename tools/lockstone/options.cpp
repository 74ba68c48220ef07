#include "tools/lockstone/options.h"

#include <map>
#include <string>

namespace lockstone::tool {

void add_broad_phase_option(CLI::App& command, BroadPhaseKind& broad_phase) {
  const std::map<std::string, BroadPhaseKind> kinds{{"tree", BroadPhaseKind::tree},
                                                    {"sweep", BroadPhaseKind::sweep_and_prune}};
  command.add_option("--broad-phase", broad_phase, "How pairs are found: tree, sweep")
      ->transform(CLI::CheckedTransformer(kinds));
}

}  // namespace lockstone::tool
