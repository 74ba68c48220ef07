#include "tools/lockstone/bench/print/bench_beside_print.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/kernels/target.h"
#include "tools/bench/charts/chart.h"
#include "tools/bench/support/machine.h"
#include "tools/lockstone/bench/print/bench_names.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

using bench::BesideFigures;
using bench::BesideRun;
using Json = nlohmann::ordered_json;

constexpr double k_ns_in_a_ms = 1e6;

// Our mean time against the engine's. Ours comes first.
double ours_to(const BesideRun& run, const BesideFigures& engine) {
  return run.figures.front().mean() / engine.mean();
}

std::string row_of(const BesideRun& run, const BesideFigures& engine, std::string_view line) {
  return fmt::format(fmt::runtime(line), run.scene, run.bodies, run.joints, run.ticks,
                     engine.engine, engine.mean() / k_ns_in_a_ms,
                     engine.quantile_of(0.99) / k_ns_in_a_ms, ours_to(run, engine), engine.height,
                     engine.asleep);
}

// A line an engine that played the scene; the others by name.
std::string rows_of(const BesideRun& run, std::string_view line) {
  if (!run.lacking.empty()) return {};
  std::string text;
  for (const BesideFigures& engine : run.figures)
    if (engine.played) text += row_of(run, engine, line);
  return text;
}

std::string reasons_of(const BesideRun& run, std::string_view line) {
  if (!run.lacking.empty())
    return fmt::format(fmt::runtime(line), run.scene, "not compared", run.lacking);
  std::string text;
  for (const BesideFigures& engine : run.figures)
    if (!engine.played)
      text += fmt::format(fmt::runtime(line), run.scene, engine.engine, "cannot do it");
  return text;
}

constexpr std::string_view k_line =
    "{:<14} {:>7} {:>7} {:>6}  {:<9} {:>10.3f} {:>10.3f} {:>7.2f} {:>9.3f} {:>7.2f}\n";
constexpr std::string_view k_page_line =
    "| {} | {} | {} | {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.3f} | {:.2f} |\n";
constexpr std::string_view k_page_head =
    "| scene | bodies | joints | ticks | engine | ms a tick | p99 | ours / engine | mean height, m "
    "| asleep |\n|---|---|---|---|---|---|---|---|---|---|\n";

bench::Chart chart_of(const IslandRuns& islands) {
  bench::Chart chart{
      fmt::format("{}: {}", islands.kind, islands.text), "bodies", "our time / the peer's", 1, {}};
  for (std::size_t i = 1; i < islands.runs.front().figures.size(); ++i) {
    bench::ChartLine line{
        islands.runs.front().figures[i].engine, static_cast<int>(i), false, true, {}};
    for (const BesideRun& run : islands.runs)
      if (run.figures[i].played)
        line.points.push_back({static_cast<double>(run.bodies), ours_to(run, run.figures[i]),
                               fmt::format("{:.2f}", ours_to(run, run.figures[i]))});
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

Json json_of(const BesideRun& run) {
  Json json{
      {"scene", run.scene}, {"bodies", run.bodies}, {"joints", run.joints}, {"ticks", run.ticks}};
  if (!run.lacking.empty()) {
    json["lacking"] = run.lacking;
    return json;
  }
  json["engines"] = Json::array();
  for (const BesideFigures& engine : run.figures) {
    if (!engine.played) continue;
    json["engines"].push_back(
        {{"engine", engine.engine},
         {"tick_ns", {{"mean", engine.mean()}, {"p99", engine.quantile_of(0.99)}}},
         {"ours_to_it", ours_to(run, engine)},
         {"height_m", engine.height},
         {"asleep", engine.asleep},
         {"had_room", engine.had_room}});
  }
  return json;
}

}  // namespace

std::string beside_head(std::string_view clock_name) {
  return fmt::format(
      "vectors: {}; clock: {}{}\n{:<14} {:>7} {:>7} {:>6}  {:<9} {:>10} {:>10} {:>7} {:>9} {:>7}\n",
      lanes::current_target(), clock_name, k_build_remark, "scene", "bodies", "joints", "ticks",
      "engine", "ms/tick", "p99", "ours/it", "height m", "asleep");
}

std::string beside_lines(const BesideRun& run) {
  return rows_of(run, k_line) + reasons_of(run, "{:<14} {}: {}\n");
}

std::string beside_page(const BesideReport& report, std::string_view command,
                        std::string_view chart) {
  std::string text = fmt::format(
      "# Speed beside other engines\n\nMade by `{}`; {}; vectors: {}; {}; commit {}; clock: {}.\n\n"
      "One thread, 60 Hz, 4 substeps of each engine; they take turns of ten ticks in one process. "
      "Each scene is read from our world, so that all have the same bodies,\n"
      "shapes, densities, friction and joints, and its bodies sleep where ours may. `ours / "
      "engine` "
      "is the ratio of the means; below 1 ours is faster.\n"
      "Bodies of like mean height at the end did the like; `asleep` is the share that sleeps then. "
      "[Benchmarks](index.md#beside-other-engines) tells more.\n",
      command, bench::machine_text(), lanes::current_target(), bench::compiler_text(),
      bench::commit_text(), report.clock_name);
  if (!report.scenes.empty()) text += fmt::format("\n## Scenes\n\n{}", k_page_head);
  for (const BesideRun& run : report.scenes)
    text += rows_of(run, k_page_line);
  text += "\n";
  for (const BesideRun& run : report.scenes)
    text += reasons_of(run, "`{}`: {}: {}.\n");
  if (report.islands.empty()) return text;
  text += "\n## Many small islands\n\nOn level ground; nothing sleeps.";
  if (!chart.empty()) text += fmt::format(" The ratios over the number: [{0}]({0}).", chart);
  text += fmt::format("\n\n{}", k_page_head);
  for (const IslandRuns& islands : report.islands)
    for (const BesideRun& run : islands.runs)
      text += rows_of(run, k_page_line);
  return text;
}

std::string islands_sheet(std::span<const IslandRuns> islands) {
  std::vector<bench::Chart> charts;
  for (const IslandRuns& kind : islands)
    charts.push_back(chart_of(kind));
  return bench::svg_sheet(charts, static_cast<int>(charts.size()));
}

void print_beside_json(const BesideReport& report) {
  Json json{{"vectors", lanes::current_target()},
            {"asserts", k_asserts},
            {"clock", report.clock_name},
            {"scenes", Json::array()},
            {"islands", Json::array()}};
  for (const BesideRun& run : report.scenes)
    json["scenes"].push_back(json_of(run));
  for (const IslandRuns& islands : report.islands)
    for (const BesideRun& run : islands.runs)
      json["islands"].push_back(json_of(run));
  write_json(json);
}

}  // namespace lockstone::tool
