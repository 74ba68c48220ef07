#include <initializer_list>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/match/net_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/suggestion.h"

namespace lockstone::tool {
namespace {

constexpr const char* k_footer =
    "Exit codes: 0 ok, 1 states differ, 2 damaged or unreadable input, 3 incompatible,\n"
    "64 wrong usage, 69 the network or the system refused.";

using AddCommand = void (*)(CLI::App& app, int& exit_code);

// Adds commands under a title of their own in the help.
void add_group(CLI::App& app, int& exit_code, const char* title,
               std::initializer_list<AddCommand> commands) {
  for (const AddCommand add : commands) {
    add(app, exit_code);
    app.get_subcommands({}).back()->group(title)->footer(k_footer);
  }
}

void add_commands(CLI::App& app, int& exit_code) {
  add_group(app, exit_code, "Scenes",
            {add_scenes_command, add_run_command, add_flips_command, add_hash_command,
             add_compare_hashes_command, add_numerics_command});
  add_group(app, exit_code, "Matches",
            {add_demo_command, add_serve_command, add_join_command, add_token_command});
  add_group(app, exit_code, "Logs",
            {add_record_command, add_info_command, add_verify_command, add_seek_command,
             add_trace_command, add_diff_command, add_bisect_command, add_repair_command,
             add_cut_command, add_keygen_command});
  add_group(app, exit_code, "Assets", {add_asset_command});
  add_group(app, exit_code, "Measuring, and looking for faults",
            {add_bench_command, add_simnet_command, add_lossy_command, add_siege_command,
             add_fuzz_pairs_command, add_fuzz_scene_command});
}

}  // namespace
}  // namespace lockstone::tool

int main(int argc, char** argv) {
  using namespace lockstone::tool;
  CLI::App app("Deterministic lockstep physics: scenes, matches and their logs.", "lockstone");
  app.set_version_flag("--version", "lockstone " LOCKSTONE_VERSION);
  app.allow_windows_style_options(false);  // "/" begins a path
  app.require_subcommand(1);
  app.footer(k_footer);
  int exit_code = k_ok;
  add_commands(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_argument(app);
    if (unknown.empty()) return app.exit(error) == 0 ? k_ok : k_usage;
    complain(unknown + "\nRun with --help for more information.");
    return k_usage;
  }
  return exit_code;
}
