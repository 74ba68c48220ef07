#include "tools/lockstone/support/options.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/kernels/target.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {

void add_broad_phase_option(CLI::App& command, BroadPhaseKind& broad_phase) {
  const auto choose = [&broad_phase](const std::string& name) {
    broad_phase = name == "sweep" ? BroadPhaseKind::sweep_and_prune : BroadPhaseKind::tree;
  };
  command
      .add_option_function<std::string>("--broad-phase", choose,
                                        "How pairs are found; changes no result")
      ->check(CLI::IsMember({"tree", "sweep"}))
      ->default_str("tree");
}

void add_simd_option(CLI::App& command) {
  const auto targets = lanes::supported_targets();
  const auto force = [](const std::string& name) { (void)lanes::set_target(name); };
  command
      .add_option_function<std::string>("--simd", force,
                                        "Vectors to use instead of the best; changes no result")
      ->check(CLI::IsMember(std::vector<std::string>(targets.begin(), targets.end())));
}

void add_vectors_option(CLI::App& command, std::string& vectors) {
  command.add_option("--vectors", vectors, "Use these instead of the widest: avx2, say");
}

bool use_vectors(const std::string& vectors) {
  if (vectors.empty() || lanes::set_target(vectors) == Status::ok) return true;
  complain(fmt::format("no vectors {} here; there are {}", vectors,
                       fmt::join(lanes::supported_targets(), ", ")));
  return false;
}

void add_threads_option(CLI::App& command, std::uint32_t& threads) {
  command.add_option("--threads", threads, "Threads to step on; changes no result")
      ->check(CLI::Range(1U, k_max_workers))
      ->capture_default_str();
}

}  // namespace lockstone::tool
