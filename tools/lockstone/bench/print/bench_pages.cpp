#include "tools/lockstone/bench/print/bench_pages.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/bench/support/machine.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

// One figure of a row at all its settings, the judged one among them.
struct PageFigure {
  const bench::AccuracyRow* row;
  std::vector<const bench::AccuracyResult*> results;

  [[nodiscard]] const bench::AccuracyResult& judged() const {
    const auto found = std::ranges::find_if(results, &bench::AccuracyResult::judged);
    return found == results.end() ? *results.front() : **found;
  }
  [[nodiscard]] std::vector<std::string> settings() const {
    std::vector<std::string> names;
    for (const bench::AccuracyResult* result : results)
      names.push_back(result->setting);
    return names;
  }
};

std::vector<PageFigure> figures_of(std::span<const MeasuredAccuracy> rows) {
  std::vector<PageFigure> figures;
  for (const MeasuredAccuracy& measured : rows) {
    for (const bench::AccuracyResult& result : measured.results) {
      const auto known = std::ranges::find_if(figures, [&](const PageFigure& figure) {
        const bench::AccuracyResult& first = *figure.results.front();
        return figure.row == measured.row && first.name == result.name && first.unit == result.unit;
      });
      if (known == figures.end())
        figures.push_back({measured.row, {&result}});
      else
        known->results.push_back(&result);
    }
  }
  return figures;
}

// Columns that are the same for all settings are left out.
std::vector<std::vector<std::string>> columns_of(const std::vector<PageFigure>& figures) {
  std::vector<std::vector<std::string>> all;
  for (const PageFigure& figure : figures) {
    const std::vector<std::string> settings = figure.settings();
    if (settings.size() > 1 && std::ranges::count(all, settings) == 0) all.push_back(settings);
  }
  all.push_back({});
  return all;
}

std::string cell(double value) {
  return value == 0 ? "0" : fmt::format("{:.2g}", value);
}

const char* verdict(bool met) {
  return met ? "met" : "**missed**";
}

std::string line_of(const PageFigure& figure) {
  const bench::AccuracyResult& judged = figure.judged();
  const std::string tries = judged.tries > 1 ? fmt::format(", {} tries", judged.tries) : "";
  std::string text = fmt::format("| {} | {}: {}{} | {} |", figure.row->number, figure.row->name,
                                 judged.name, tries, judged.unit);
  for (const bench::AccuracyResult* result : figure.results)
    text += fmt::format(" {} |", cell(result->worst));
  if (judged.judged)
    text += fmt::format(" {} | {} |", cell(judged.goal), verdict(judged.met()));
  else
    text += " | |";
  return text + fmt::format(" {} |\n", judged.hash == 0 ? "" : hash_text(judged.hash));
}

std::string table_of(const std::vector<PageFigure>& figures,
                     const std::vector<std::string>& columns) {
  std::string lines;
  for (const PageFigure& figure : figures) {
    const bool fits = columns.empty() ? figure.results.size() == 1 : figure.settings() == columns;
    if (fits) lines += line_of(figure);
  }
  if (lines.empty()) return {};
  const std::vector<std::string> names =
      columns.empty() ? std::vector<std::string>{"worst"} : columns;
  std::string text =
      fmt::format("\n| row | figure | unit | {} | goal | verdict | state |\n|---|---|---|",
                  fmt::join(names, " | "));
  for (std::size_t i = 0; i < names.size(); ++i)
    text += "---|";
  return text + "---|---|---|\n" + lines;
}

std::string head(std::string_view title, std::string_view command) {
  return fmt::format("# {}\n\nMade by `{}`; {}; {}; commit {}.\n", title, command,
                     bench::machine_text(), bench::compiler_text(), bench::commit_text());
}

}  // namespace

std::string accuracy_page(std::span<const MeasuredAccuracy> rows, std::string_view command) {
  const std::vector<PageFigure> figures = figures_of(rows);
  std::string text = head("Errors against exact references", command);
  text +=
      "\nEach figure is the worst of its row. Settings are ticks a second and substeps of a tick; "
      "the goal is held at 60 Hz x 4. The state is\n"
      "the hash at the end of that run, the same on every machine. [Benchmarks](index.md) "
      "describes the rows.\n";
  for (const std::vector<std::string>& columns : columns_of(figures))
    text += table_of(figures, columns);
  return text;
}

std::string stability_page(std::span<const MeasuredStability> rows, std::string_view command) {
  std::string text = head("Scenes that break engines, over long runs", command);
  text +=
      "\nEach figure is the worst over the run. The state is the hash at the end of the run, "
      "the same on every machine.\n\n| row | figure | unit | worst | bound | verdict | ticks | "
      "state "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const MeasuredStability& measured : rows) {
    for (const bench::StabilityFigure& figure : measured.result.figures)
      text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", measured.row->text,
                          figure.name, figure.unit, cell(figure.value), cell(figure.bound),
                          verdict(figure.met()), measured.result.ticks,
                          hash_text(measured.result.hash));
  }
  return text;
}

}  // namespace lockstone::tool
