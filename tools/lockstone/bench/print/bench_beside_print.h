// The output of `lockstone bench speed --peers` and `--islands`.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/bench/beside/beside_run.h"

namespace lockstone::tool {

/// Islands of one kind in worlds of ever more bodies.
struct IslandRuns {
  std::string kind;
  std::string text;
  std::vector<bench::BesideRun> runs;
};

struct BesideReport {
  std::string clock_name;
  std::vector<bench::BesideRun> scenes;
  std::vector<IslandRuns> islands;
};

/// The table's first lines.
[[nodiscard]] std::string beside_head(std::string_view clock_name);

/// A line an engine; of those that have no figures, the reason.
[[nodiscard]] std::string beside_lines(const bench::BesideRun& run);

/// The table as Markdown, with a head that describes it. `chart`: the name of the islands' chart
/// beside it; empty: none.
[[nodiscard]] std::string beside_page(const BesideReport& report, std::string_view command,
                                      std::string_view chart);

/// Our time against each peer's over the number of bodies, a chart a kind, as one SVG.
[[nodiscard]] std::string islands_sheet(std::span<const IslandRuns> islands);

void print_beside_json(const BesideReport& report);

}  // namespace lockstone::tool
