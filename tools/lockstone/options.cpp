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

void add_threads_option(CLI::App& command, std::uint32_t& threads) {
  command.add_option("--threads", threads, "Threads to step on; changes no result")
      ->check(CLI::Range(1U, k_max_workers))
      ->capture_default_str();
}

}  // namespace lockstone::tool
