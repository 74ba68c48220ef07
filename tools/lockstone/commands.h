// The subcommands: each adds itself to the command line and, when chosen, sets the exit code.
#pragma once

#include <CLI/App.hpp>

namespace lockstone::tool {

struct Tool;

/// The command's exit codes.
enum ExitCode : int {
  k_ok = 0,
  k_different = 1,     ///< states diverged
  k_corrupt = 2,       ///< damaged or unreadable input
  k_incompatible = 3,  ///< of another simulation, configuration or format version
  k_usage = 64,
  k_unavailable = 69,  ///< the network or the system refused
};

void add_scenes_command(CLI::App& app, int& exit_code);
void add_run_command(CLI::App& app, Tool& tool);
void add_numerics_command(CLI::App& app, int& exit_code);
void add_demo_command(CLI::App& app, Tool& tool);
void add_studio_command(CLI::App& app, Tool& tool);
[[nodiscard]] bool has_studio();  ///< its page is embedded
void add_fuzz_pairs_command(CLI::App& app, int& exit_code);
void add_fuzz_rollback_command(CLI::App& app, int& exit_code);
void add_fuzz_scene_command(CLI::App& app, int& exit_code);
void add_fuzz_vectors_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_asset_command(CLI::App& app, int& exit_code);

}  // namespace lockstone::tool
