#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/bench/skip/skip.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

using Json = nlohmann::ordered_json;

struct BenchSkipOptions {
  bench::SkipOptions measure;
  bool json = false;
};

void print(const std::vector<bench::SkipFigure>& figures) {
  std::string_view claim;
  for (const bench::SkipFigure& figure : figures) {
    if (figure.claim != claim) fmt::print("{}\n", claim = figure.claim);
    fmt::print("  {:<62} {:>9.4g} {:<6} goal {} {:>6.4g}  {}\n", figure.figure, figure.value,
               figure.unit, figure.at_least ? ">=" : "<=", figure.goal,
               figure.met() ? "met" : "MISSED");
  }
}

Json json_of(const bench::SkipFigure& figure) {
  return {{"claim", figure.claim}, {"figure", figure.figure},
          {"value", figure.value}, {"unit", figure.unit},
          {"goal", figure.goal},   {"goal_is", figure.at_least ? "least" : "most"},
          {"met", figure.met()},   {"is_time", figure.is_time}};
}

int run(const BenchSkipOptions& options) {
  const std::vector<bench::SkipFigure> figures = bench::measure_skips(options.measure);
  if (options.json) {
    Json json = Json::array();
    for (const bench::SkipFigure& figure : figures)
      json.push_back(json_of(figure));
    write_json(json);
  } else {
    print(figures);
  }
  return std::ranges::all_of(figures, &bench::SkipFigure::met) ? k_ok : k_different;
}

}  // namespace

void add_bench_skip_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchSkipOptions>();
  CLI::App* command =
      bench.add_subcommand("skip", "A scene does not pay for features it does not use");
  command->add_flag_callback(
      "--no-times", [options] { options->measure.times = false; }, "Counters and sizes alone");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
