#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "tools/bench/accuracy/accuracy.h"
#include "tools/lockstone/bench/print/bench_front.h"
#include "tools/lockstone/bench/print/bench_pages.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

using Json = nlohmann::ordered_json;

struct BenchAccuracyOptions {
  bench::AccuracyOptions measure;
  std::vector<int> rows;  // empty: all
  bool json = false;
  std::string page;  // empty: none
  bool force = false;
  std::string plot;  // empty: rows instead of charts
  FrontOptions front;
};

MeasuredAccuracy measure(const bench::AccuracyRow& row, bench::AccuracyOptions options) {
  const Stopwatch watch;
  if (options.tries == 0) options.tries = row.tries;
  std::vector<bench::AccuracyResult> results = row.run(options);
  return {&row, std::move(results), watch.seconds()};
}

void print(const MeasuredAccuracy& measured) {
  fmt::print("row {}: {} ({:.1f} s)\n", measured.row->number, measured.row->name, measured.seconds);
  for (const bench::AccuracyResult& result : measured.results) {
    const char* verdict = !result.judged ? "" : result.met() ? "met" : "MISSED";
    const char* comma = result.setting.empty() ? "" : ", ";
    fmt::print("  {:<38} {:>9} tries  worst {:>10.3g} {:<8} goal {:>9.3g}  {:<6} {}",
               result.name + comma + result.setting, result.tries, result.worst, result.unit,
               result.goal, verdict, result.note);
    if (result.tick_seconds > 0)
      fmt::print(" {:.2f} us a tick, hash {:016x}", result.tick_seconds * 1e6, result.hash);
    fmt::print("\n");
  }
}

Json json_of(const MeasuredAccuracy& measured) {
  Json json{{"row", measured.row->number},
            {"name", measured.row->name},
            {"seconds", measured.seconds},
            {"results", Json::array()}};
  for (const bench::AccuracyResult& result : measured.results)
    json["results"].push_back({{"name", result.name},
                               {"setting", result.setting},
                               {"tries", result.tries},
                               {"worst", result.worst},
                               {"unit", result.unit},
                               {"goal", result.goal},
                               {"judged", result.judged},
                               {"met", result.met()},
                               {"tick_seconds", result.tick_seconds},
                               {"hash", fmt::format("{:016x}", result.hash)},
                               {"note", result.note}});
  return json;
}

void print_json(const std::vector<MeasuredAccuracy>& all) {
  Json json = Json::array();
  for (const MeasuredAccuracy& measured : all)
    json.push_back(json_of(measured));
  write_json(json);
}

bool is_chosen(const BenchAccuracyOptions& options, int number) {
  return options.rows.empty() || std::ranges::count(options.rows, number) > 0;
}

// That makes the same page again, in the place of this one.
std::string command_of(const BenchAccuracyOptions& options) {
  std::string command = "lockstone bench accuracy";
  if (!options.rows.empty()) command += fmt::format(" --rows {}", fmt::join(options.rows, ","));
  if (options.measure.tries != 0) command += fmt::format(" --tries {}", options.measure.tries);
  if (options.measure.first != 0) command += fmt::format(" --first {}", options.measure.first);
  if (options.measure.seed != 1) command += fmt::format(" --seed {}", options.measure.seed);
  if (options.measure.sweep) command += " --sweep";
  return command + " --page " + options.page + " --force";
}

int plot(const BenchAccuracyOptions& options) {
  const std::string command =
      fmt::format("lockstone bench accuracy --plot {} --force", options.plot);
  const Output output{options.plot, options.force};
  if (!may_write_front(output)) return k_unavailable;
  const MeasuredFront measured = measure_front(options.front);
  if (!write_front(measured, output, command)) return k_unavailable;
  return measured.other_states.empty() ? k_ok : k_different;
}

int run(const BenchAccuracyOptions& options) {
  if (!options.plot.empty()) return plot(options);
  const Output page{options.page, options.force};
  if (!may_write(page)) return k_unavailable;
  std::vector<MeasuredAccuracy> all;
  bool met = true;
  for (const bench::AccuracyRow& row : bench::accuracy_rows()) {
    if (!is_chosen(options, row.number)) continue;
    const MeasuredAccuracy& measured = all.emplace_back(measure(row, options.measure));
    met = met && std::ranges::all_of(measured.results, &bench::AccuracyResult::met);
    if (!options.json) print(measured);
  }
  if (options.json) print_json(all);
  if (!options.page.empty()) {
    if (!write_text_file(page, accuracy_page(all, command_of(options)))) return k_unavailable;
  }
  return met ? k_ok : k_different;
}

}  // namespace

void add_bench_accuracy_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchAccuracyOptions>();
  options->measure.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::vector<int> numbers;
  for (const bench::AccuracyRow& row : bench::accuracy_rows())
    numbers.push_back(row.number);
  CLI::App* command = bench.add_subcommand("accuracy", "Errors against exact references");
  command->add_option("--rows", options->rows, "Numbers of rows; all when left out")
      ->delimiter(',')
      ->check(CLI::IsMember(numbers));
  command->add_option("--tries", options->measure.tries,
                      "Tries of each row; 0: the row's own number");
  command->add_option("--first", options->measure.first, "Number of the first try, to repeat one");
  command->add_option("--seed", options->measure.seed, "Seed of the tries")->capture_default_str();
  command->add_option("--threads", options->measure.threads, "The result does not depend on them")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--sweep", options->measure.sweep,
                    "Rows of contact at 1, 2, 4, 8 and 16 substeps");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_option("--page", options->page,
                      "Also write the figures as tables, into a file *.md");
  command->add_option("--plot", options->plot,
                      "Instead: time against error of all engines as charts, into a folder or one "
                      "file *.svg");
  add_force_option(*command, options->force);
  add_front_options(*command, options->front);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
