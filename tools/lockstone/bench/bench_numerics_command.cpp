#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/numerics/bench.h"

namespace lockstone::tool {
namespace {

struct BenchNumericsOptions {
  int repeats = 31;
  bool json = false;
};

void print_json(const std::vector<numerics::BenchRow>& rows) {
  nlohmann::ordered_json json{{"exact", numerics::exact_source()}, {"functions", nullptr}};
  for (const numerics::BenchRow& row : rows) {
    nlohmann::ordered_json entry{
        {"function", row.function}, {"format", row.format}, {"low", row.low}, {"high", row.high}};
    for (std::size_t i = 0; i < row.results.size(); ++i) {
      entry[numerics::k_implementations[i]] = {{"nanoseconds", row.results[i].nanoseconds},
                                               {"max_error", row.results[i].max_error}};
    }
    json["functions"].push_back(std::move(entry));
  }
  write_json(json);
}

void print_table(const std::vector<numerics::BenchRow>& rows) {
  fmt::print("ns a call (median) and greatest absolute error against {}\n{:<11}{:<12}{:>14}",
             numerics::exact_source(), "", "ours", "range");
  for (const char* name : numerics::k_implementations)
    fmt::print(" | {:<16}", name);
  fmt::print("\n");
  for (const numerics::BenchRow& row : rows) {
    // The arrow takes three bytes and one column: pad by hand.
    const std::string range = fmt::format("{:g} … {:g}", row.low, row.high);
    fmt::print("{:<11}{}{:<2}{:>14}", row.function, row.format, "", range);
    for (const numerics::Measured& result : row.results)
      fmt::print(" | {:>6.1f} {:>9.2e}", result.nanoseconds, result.max_error);
    fmt::print("\n");
  }
}

}  // namespace

void add_bench_numerics_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchNumericsOptions>();
  CLI::App* command = bench.add_subcommand(
      "numerics", "Time and error of the functions, beside Q16.16, float and double");
  command->add_option("--repeats", options->repeats, "Timed runs of 4096 calls each")
      ->check(CLI::Range(1, 10000));
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] {
    const auto rows = numerics::bench_numerics(options->repeats);
    options->json ? print_json(rows) : print_table(rows);
    exit_code = k_ok;
  });
}

}  // namespace lockstone::tool
