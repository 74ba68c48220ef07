#include <memory>
#include <string>

#include <fmt/format.h>

#include "tools/bench/rows/bench_rows.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

void print(const bench::RowBench& rows) {
  const double reference = rows.results.front().quantile(0.5);
  fmt::print("{} contacts of four points, ns per contact and iteration\n", rows.contacts);
  fmt::print("{:<20} {:>8} {:>8} {:>8} {:>7}  final hash\n", "", "median", "p99", "least", "ratio");
  for (const bench::RowBenchResult& result : rows.results) {
    fmt::print("{:<20} {:>8.2f} {:>8.2f} {:>8.2f} {:>7.2f}  {}\n", result.name,
               result.quantile(0.5), result.quantile(0.99), result.quantile(0),
               result.quantile(0.5) / reference,
               result.hash == 0 ? std::string() : hash_text(result.hash));
  }
}

int run(const bench::RowBenchOptions& options) {
  const bench::RowBench rows = run_row_bench(options);
  print(rows);
  if (rows.hashes_agree()) return k_ok;
  complain("the targets computed different states");
  return k_different;
}

}  // namespace

void add_bench_rows_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<bench::RowBenchOptions>();
  CLI::App* command =
      bench.add_subcommand("rows", "Contact rows: integers on each target beside floating point");
  command->add_option("--bodies", options->bodies, "Number of moving bodies")
      ->capture_default_str()
      ->check(CLI::Range(16, 1 << 20));
  command->add_option("--colours", options->colours, "Rounds of matching the bodies in pairs")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 10));
  command->add_option("--repeats", options->repeats, "Timed repeats")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--seed", options->seed, "Seed of the contacts")->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
