// The subcommands that measure and fuzz, in a build without them.
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/absent_command.h"

namespace lockstone::tool {

static constexpr const char* k_no_bench = "LOCKSTONE_BUILD_BENCH is off";

void add_bench_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "bench", k_no_bench);
}
void add_fuzz_pairs_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "fuzz-pairs", k_no_bench);
}
void add_fuzz_scene_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "fuzz-scene", k_no_bench);
}
void add_fuzz_rollback_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "fuzz-rollback", k_no_bench);
}
void add_fuzz_vectors_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "fuzz-vectors", k_no_bench);
}

}  // namespace lockstone::tool
