#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/log_commands.h"
#include "tools/lockstone/net_commands.h"

namespace {

constexpr const char* k_footer =
    "Exit codes: 0 ok, 1 states differ, 2 damaged or unreadable input, 3 incompatible,\n"
    "64 wrong usage, 69 the network or the system refused.";

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Deterministic lockstep physics: scenes, matches and their logs.", "lockstone");
  app.set_version_flag("--version", "lockstone " LOCKSTONE_VERSION);
  app.allow_windows_style_options(false);  // "/" begins a path
  app.require_subcommand(1);
  app.footer(k_footer);
  int exit_code = lockstone::tool::k_ok;
  lockstone::tool::add_scenes_command(app, exit_code);
  lockstone::tool::add_run_command(app, exit_code);
  lockstone::tool::add_info_command(app, exit_code);
  lockstone::tool::add_verify_command(app, exit_code);
  lockstone::tool::add_record_command(app, exit_code);
  lockstone::tool::add_seek_command(app, exit_code);
  lockstone::tool::add_trace_command(app, exit_code);
  lockstone::tool::add_diff_command(app, exit_code);
  lockstone::tool::add_bisect_command(app, exit_code);
  lockstone::tool::add_repair_command(app, exit_code);
  lockstone::tool::add_cut_command(app, exit_code);
  lockstone::tool::add_flips_command(app, exit_code);
  lockstone::tool::add_hash_command(app, exit_code);
  lockstone::tool::add_compare_hashes_command(app, exit_code);
  lockstone::tool::add_keygen_command(app, exit_code);
  lockstone::tool::add_numerics_command(app, exit_code);
  lockstone::tool::add_serve_command(app, exit_code);
  lockstone::tool::add_join_command(app, exit_code);
  lockstone::tool::add_demo_command(app, exit_code);
  lockstone::tool::add_token_command(app, exit_code);
  lockstone::tool::add_lossy_command(app, exit_code);
  lockstone::tool::add_siege_command(app, exit_code);
  lockstone::tool::add_fuzz_pairs_command(app, exit_code);
  lockstone::tool::add_fuzz_scene_command(app, exit_code);
  lockstone::tool::add_bench_command(app, exit_code);
  lockstone::tool::add_simnet_command(app, exit_code);
  lockstone::tool::add_asset_command(app, exit_code);
  for (CLI::App* command : app.get_subcommands({}))
    command->footer(k_footer);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? lockstone::tool::k_ok : lockstone::tool::k_usage;
  }
  return exit_code;
}
