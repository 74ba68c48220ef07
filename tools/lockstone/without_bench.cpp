// The subcommands that measure and fuzz, in a build without them.
#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"

namespace lockstone::tool {
namespace {

void add_absent_bench(CLI::App& app, int& exit_code, const char* name) {
  CLI::App* command = app.add_subcommand(name, "Not in this build: LOCKSTONE_BUILD_BENCH is off");
  command->allow_extras();
  command->callback([name, &exit_code] {
    complain(fmt::format("{}: not in this build (LOCKSTONE_BUILD_BENCH is off)", name));
    exit_code = k_unavailable;
  });
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  add_absent_bench(app, exit_code, "bench");
}
void add_fuzz_pairs_command(CLI::App& app, int& exit_code) {
  add_absent_bench(app, exit_code, "fuzz-pairs");
}
void add_fuzz_scene_command(CLI::App& app, int& exit_code) {
  add_absent_bench(app, exit_code, "fuzz-scene");
}

}  // namespace lockstone::tool
