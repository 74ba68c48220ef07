#include "tools/lockstone/commands.h"

namespace lockstone::tool {

void add_bench_accuracy_command(CLI::App& bench, int& exit_code);
void add_bench_general_command(CLI::App& bench, int& exit_code);
void add_bench_hosting_command(CLI::App& bench, int& exit_code);
void add_bench_numerics_command(CLI::App& bench, int& exit_code);
void add_bench_queries_command(CLI::App& bench, int& exit_code);
void add_bench_rollback_command(CLI::App& bench, int& exit_code);
void add_bench_rows_command(CLI::App& bench, int& exit_code);
void add_bench_scenes_command(CLI::App& bench, int& exit_code);
void add_bench_size_command(CLI::App& bench, int& exit_code);
void add_bench_skip_command(CLI::App& bench, int& exit_code);
void add_bench_stability_command(CLI::App& bench, int& exit_code);
void add_bench_speed_command(CLI::App& bench, int& exit_code);

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* bench = app.add_subcommand("bench", "Measure the core and its parts");
  bench->require_subcommand(1);
  add_bench_accuracy_command(*bench, exit_code);
  add_bench_general_command(*bench, exit_code);
#ifdef LOCKSTONE_WITH_ENET
  add_bench_hosting_command(*bench, exit_code);
#endif
  add_bench_numerics_command(*bench, exit_code);
  add_bench_queries_command(*bench, exit_code);
  add_bench_rollback_command(*bench, exit_code);
  add_bench_rows_command(*bench, exit_code);
  add_bench_scenes_command(*bench, exit_code);
  add_bench_size_command(*bench, exit_code);
  add_bench_skip_command(*bench, exit_code);
  add_bench_stability_command(*bench, exit_code);
  add_bench_speed_command(*bench, exit_code);
}

}  // namespace lockstone::tool
