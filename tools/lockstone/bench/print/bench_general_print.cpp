#include "tools/lockstone/bench/print/bench_general_print.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/bench/charts/chart.h"
#include "tools/bench/support/machine.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

using bench::FamilyRun;
using bench::GeneralFigures;

constexpr double k_p99 = 0.99, k_median = 0.5;
constexpr double k_least_drawn = 1e-6;  // an axis in logarithms has no 0

std::string_view unit_of(bench::Judge judge) {
  constexpr auto k_units = std::to_array<std::string_view>(
      {"m moved", "m gap", "speed off", "rad off", "rad off", "swing lost", "lost", "gained",
       "missed", "unseen", "m fallen", "m sunk", "m/s", "m up", "slowed", "awake", "m out"});
  static_assert(k_units.size() == bench::k_judges);
  return k_units[static_cast<std::size_t>(judge)];
}

bool was_played(const FamilyRun& run) {
  return std::ranges::any_of(run.figures, [](const auto& seed) { return seed.has_value(); });
}

std::string row_of(const FamilyRun& run, std::string_view line) {
  const bench::GeneralScene scene = bench::make_scene(*run.family, 1);
  if (!was_played(run)) return fmt::format("{} {}: cannot do it\n", run.family->name, run.engine);
  const auto figure = [&](double GeneralFigures::*which, double share) {
    return run.quantile_of(which, share);
  };
  return fmt::format(fmt::runtime(line), run.family->name, run.engine, unit_of(scene.judge),
                     figure(&GeneralFigures::error, 1), figure(&GeneralFigures::error, k_p99),
                     figure(&GeneralFigures::error, k_median), scene.bound,
                     figure(&GeneralFigures::gain, 1), figure(&GeneralFigures::speed, 1),
                     figure(&GeneralFigures::rest, 1), figure(&GeneralFigures::asleep, 0),
                     figure(&GeneralFigures::tick_micros, k_median), run.failures(),
                     run.figures.size());
}

nlohmann::ordered_json json_of(const GeneralFigures& f, std::uint64_t seed) {
  return {{"seed", seed},           {"error", f.error},
          {"gap", f.gap},           {"gain", f.gain},
          {"speed", f.speed},       {"rest_s", f.rest},
          {"asleep", f.asleep},     {"tick_us", f.tick_micros},
          {"contacts", f.contacts}, {"hash", hash_text(f.hash)},
          {"failed", f.failed}};
}

// Sorted, so that the curve's end is the worst seed.
bench::ChartLine line_of(const FamilyRun& run, int colour) {
  std::vector<double> errors;
  for (const auto& seed : run.figures)
    if (seed.has_value()) errors.push_back(std::max(seed->error, k_least_drawn));
  std::ranges::sort(errors);
  bench::ChartLine line{run.engine, colour, false, colour == 0, {}};
  for (std::size_t i = 0; i < errors.size(); ++i)
    line.points.push_back({static_cast<double>(i + 1), errors[i], ""});
  return line;
}

// The worst error of an engine in each half octave of contacts. Seeds are told apart by the
// contacts that `counted`, our run of the same seeds, had.
bench::ChartLine by_contacts(const FamilyRun& run, const FamilyRun& counted, int colour) {
  std::map<int, double> worst;
  for (std::size_t i = 0; i < run.figures.size(); ++i) {
    if (!run.figures[i].has_value() || !counted.figures[i].has_value()) continue;
    if (counted.figures[i]->contacts == 0) continue;
    const auto bin = static_cast<int>(std::lround(2 * std::log2(counted.figures[i]->contacts)));
    worst[bin] = std::max({worst[bin], run.figures[i]->error, k_least_drawn});
  }
  bench::ChartLine line{run.engine, colour, false, colour == 0, {}};
  for (const auto& [bin, error] : worst)
    line.points.push_back({std::exp2(0.5 * bin), error, ""});
  return line;
}

}  // namespace

std::string general_table(std::span<const FamilyRun> runs) {
  std::string text = fmt::format(
      "{:<15} {:<9} {:<10} {:>8} {:>8} {:>8} {:>7} {:>8} {:>7} {:>6} "
      "{:>6} {:>8} {:>9}\n",
      "family", "engine", "error", "worst", "p99", "median", "bound", "gain", "m/s", "rest s",
      "asleep", "us/tick", "failed");
  for (const FamilyRun& run : runs)
    text += row_of(run,
                   "{:<15} {:<9} {:<10} {:>8.2g} {:>8.2g} {:>8.2g} {:>7.2g} {:>8.2g} {:>7.3g} "
                   "{:>6.1f} {:>6.2f} {:>8.3g} {:>4}/{}\n");
  return text;
}

std::string general_failures(std::span<const FamilyRun> runs, std::uint64_t first_seed,
                             std::string_view settings) {
  std::string text;
  for (const FamilyRun& run : runs) {
    if (run.engine != "lockstone") continue;
    for (std::size_t i = 0; i < run.figures.size(); ++i) {
      if (run.figures[i].has_value() && run.figures[i]->failed)
        text += fmt::format("failed: lockstone bench general{} --replay {}:{}\n", settings,
                            run.family->name, first_seed + i);
    }
  }
  return text;
}

std::string general_page(std::span<const FamilyRun> runs, std::string_view command,
                         std::string_view contacts) {
  std::string text = fmt::format(
      "# Families of scenes\n\nMade by `{}`; {}; {}; commit {}.\n\n"
      "Each family is a generator: sizes, masses, friction, angles, jitter and counts come from "
      "the seed. The error has the unit named, and must not exceed the bound;\n"
      "`gain` is the most energy regained, as a share of the first energy; `rest` the worst time "
      "until all is still; `asleep` the least share of sleepers at the end.\n"
      "A row says failed where its error, its energy or its rest is outside the family's bounds. "
      "`lockstone bench general --replay FAMILY:SEED` plays a seed again,\n"
      "`--svg FILE` draws it, `--shrink` makes it smaller while it still fails.\n\n"
      "| family | engine | error | worst | p99 | median | bound | gain | m/s | rest, s | asleep | "
      "µs a tick | failed |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      command, bench::machine_text(), bench::compiler_text(), bench::commit_text());
  if (!contacts.empty())
    text.insert(text.find("| family"),
                fmt::format("The worst error of each scene over its number of contacts: [{0}]({0})."
                            "\n\n",
                            contacts));
  for (const FamilyRun& run : runs)
    text += row_of(run,
                   "| {} | {} | {} | {:.2g} | {:.2g} | {:.2g} | {:.2g} | {:.2g} | {:.3g} | {:.1f} "
                   "| {:.2f} | {:.3g} | {}/{} |\n");
  return text;
}

bool plot_general(std::span<const FamilyRun> runs, const Output& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder.path, error);
  std::map<std::string, bench::Chart> charts;
  std::map<std::string, int> colours;
  for (const FamilyRun& run : runs) {
    if (!was_played(run)) continue;
    const bench::GeneralScene scene = bench::make_scene(*run.family, 1);
    bench::Chart& chart = charts[std::string(run.family->name)];
    chart.title = fmt::format("{}: {}", run.family->name, run.family->text);
    chart.x_label = "seeds in order of error";
    chart.y_label = unit_of(scene.judge);
    chart.goal = scene.bound;
    const auto colour = colours.emplace(run.engine, static_cast<int>(colours.size())).first;
    chart.lines.push_back(line_of(run, colour->second));
  }
  bool written = true;
  for (const auto& [name, chart] : charts)
    written = write_text_file({fmt::format("{}/{}.svg", folder.path, name), folder.force},
                              bench::svg_of(chart)) &&
              written;
  return written;
}

std::string contacts_sheet(std::span<const FamilyRun> runs) {
  std::vector<bench::Chart> charts;
  const FamilyRun* counted = nullptr;
  for (const FamilyRun& run : runs) {
    if (counted == nullptr || counted->family != run.family) {
      counted = &run;  // ours comes first in each family
      const bench::GeneralScene scene = bench::make_scene(*run.family, 1);
      bench::Chart& chart = charts.emplace_back();
      chart.title = run.family->name;
      chart.x_label = "contacts";
      chart.y_label = fmt::format("{}, the worst", unit_of(scene.judge));
      chart.goal = scene.bound;
    }
    bench::Chart& chart = charts.back();
    chart.lines.push_back(by_contacts(run, *counted, static_cast<int>(chart.lines.size())));
  }
  constexpr int k_columns = 2;
  return bench::svg_sheet(charts, k_columns);
}

void print_general_json(std::span<const FamilyRun> runs, std::uint64_t first_seed) {
  auto all = nlohmann::ordered_json::array();
  for (const FamilyRun& run : runs) {
    nlohmann::ordered_json row{{"family", run.family->name},
                               {"engine", run.engine},
                               {"failures", run.failures()},
                               {"seeds", nlohmann::ordered_json::array()}};
    for (std::size_t i = 0; i < run.figures.size(); ++i)
      if (run.figures[i].has_value())
        row["seeds"].push_back(json_of(*run.figures[i], first_seed + i));
    all.push_back(std::move(row));
  }
  write_json(all);
}

}  // namespace lockstone::tool
