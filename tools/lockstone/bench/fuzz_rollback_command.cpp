#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/fuzz/rollback_fuzz.h"
#include "tools/lockstone/bench/fuzz_options.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

struct FuzzRollbackOptions {
  fuzz::RollbackFuzzOptions run;
  bool json = false;
};

std::string reproducer(const FuzzRollbackOptions& options, const fuzz::RollbackFailure& failure) {
  return fmt::format("lockstone fuzz-rollback --seed {} --first {} --count 1 --rounds {}",
                     options.run.seed, failure.index, options.run.rounds);
}

void print_text(const FuzzRollbackOptions& options, const fuzz::RollbackFuzzReport& report) {
  fmt::print("seed {}, {} worlds, {} rollbacks, {} ticks, {} failed\n", options.run.seed,
             report.worlds, report.rollbacks, report.ticks, report.failures.size());
  fmt::print("{} islands computed, {} recalled; {} ticks recalled in part, {} whole\n",
             report.computed_islands, report.recalled_islands, report.partial_ticks,
             report.whole_ticks);
  for (const fuzz::RollbackFailure& failure : report.failures)
    fmt::print("FAILED at tick {}: {}\n  {}\n", failure.tick, failure.what,
               reproducer(options, failure));
}

void print_json(const FuzzRollbackOptions& options, const fuzz::RollbackFuzzReport& report) {
  nlohmann::ordered_json document{{"seed", options.run.seed},
                                  {"worlds", report.worlds},
                                  {"rollbacks", report.rollbacks},
                                  {"ticks", report.ticks},
                                  {"computed_islands", report.computed_islands},
                                  {"recalled_islands", report.recalled_islands},
                                  {"partial_ticks", report.partial_ticks},
                                  {"whole_ticks", report.whole_ticks},
                                  {"failures", nlohmann::ordered_json::array()}};
  for (const fuzz::RollbackFailure& failure : report.failures)
    document["failures"].push_back({{"index", failure.index},
                                    {"tick", failure.tick},
                                    {"what", failure.what},
                                    {"reproducer", reproducer(options, failure)}});
  write_json(document);
}

int run(const FuzzRollbackOptions& options) {
  const fuzz::RollbackFuzzReport report = fuzz::fuzz_rollbacks(options.run);
  options.json ? print_json(options, report) : print_text(options, report);
  return report.failures.empty() ? k_ok : k_different;
}

}  // namespace

void add_fuzz_rollback_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FuzzRollbackOptions>();
  CLI::App* command = app.add_subcommand(
      "fuzz-rollback", "Random rollbacks with a history, compared with worlds that never go back");
  add_fuzz_options(*command, options->run, options->json, "worlds");
  command->add_option("--rounds", options->run.rounds, "Rollbacks of each")->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
