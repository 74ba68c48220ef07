#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tools/bench/stability/stability.h"
#include "tools/lockstone/bench/print/bench_pages.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

struct BenchStabilityOptions {
  bench::StabilityOptions measure;
  std::vector<std::string> rows;
  bool json = false;
  std::string page;  // empty: none
  bool force = false;
};

void print_text(const MeasuredStability& measured) {
  const auto& [row, result] = measured;
  fmt::print("{}: {} ({} ticks, {:.3f} ms a tick, hash {})\n", row->name, row->text, result.ticks,
             1e3 * result.tick_seconds, hash_text(result.hash));
  for (const bench::StabilityFigure& figure : result.figures)
    fmt::print("  {:<34} {:>10.3g} {:<4} bound {:>8.3g}  {}\n", figure.name, figure.value,
               figure.unit, figure.bound, figure.met() ? "met" : "MISSED");
  std::fflush(stdout);
}

nlohmann::ordered_json json_of(const MeasuredStability& measured) {
  const auto& [row, result] = measured;
  nlohmann::ordered_json document{{"row", row->name},
                                  {"ticks", result.ticks},
                                  {"tick_ms", 1e3 * result.tick_seconds},
                                  {"hash", hash_text(result.hash)},
                                  {"figures", nlohmann::ordered_json::array()}};
  for (const bench::StabilityFigure& figure : result.figures)
    document["figures"].push_back({{"name", figure.name},
                                   {"unit", figure.unit},
                                   {"value", figure.value},
                                   {"bound", figure.bound},
                                   {"met", figure.met()}});
  return document;
}

void print_json(const std::vector<MeasuredStability>& all) {
  auto rows = nlohmann::ordered_json::array();
  for (const MeasuredStability& measured : all)
    rows.push_back(json_of(measured));
  write_json(rows);
}

// That makes the same page again, in the place of this one.
std::string command_of(const BenchStabilityOptions& options) {
  std::string command = "lockstone bench stability";
  if (!options.rows.empty()) command += fmt::format(" --rows {}", fmt::join(options.rows, " "));
  if (options.measure.seconds > 0) command += fmt::format(" --seconds {}", options.measure.seconds);
  return command + " --page " + options.page + " --force";
}

int run(const BenchStabilityOptions& options) {
  const Output page{options.page, options.force};
  if (!may_write(page)) return k_unavailable;
  bool met = true;
  std::vector<MeasuredStability> all;
  for (const bench::StabilityRow& row : bench::stability_rows()) {
    const bool wanted = options.rows.empty() || std::find(options.rows.begin(), options.rows.end(),
                                                          row.name) != options.rows.end();
    if (!wanted) continue;
    const MeasuredStability& measured =
        all.emplace_back(MeasuredStability{&row, run_stability_row(row, options.measure)});
    for (const bench::StabilityFigure& figure : measured.result.figures)
      met = met && figure.met();
    if (!options.json) print_text(measured);
  }
  if (options.json) print_json(all);
  if (!options.page.empty()) {
    if (!write_text_file(page, stability_page(all, command_of(options)))) return k_unavailable;
  }
  return met ? k_ok : k_different;
}

std::string check_row(const std::string& name) {
  return bench::find_stability_row(name) != nullptr ? std::string() : "no row: " + name;
}

}  // namespace

void add_bench_stability_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchStabilityOptions>();
  CLI::App* command =
      bench.add_subcommand("stability", "Scenes that break engines, over long runs, with bounds");
  command->add_option("--rows", options->rows, "Names; all when left out")
      ->check(CLI::Validator(check_row, "ROW"));
  command->add_option("--seconds", options->measure.seconds,
                      "Length of each run in the world's time; default: the row's own");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_option("--page", options->page,
                      "Also write the figures as a table, into a file *.md");
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
