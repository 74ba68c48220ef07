// The summary of all fronts: one line a scene and peer, wins and losses counted.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/bench/charts/front.h"

namespace lockstone::bench {

struct PageFacts {
  std::string machine;
  std::string compiler;
  std::string commit;
  std::string command;
  std::vector<std::string> absent;  ///< engines, with their requirements
  std::string states;               ///< how many of our final states agree; empty: not compared
};

/// Markdown. With `charts`, each table has its picture NAME.svg beside it.
[[nodiscard]] std::string front_page(const std::vector<Front>& fronts, const PageFacts& facts,
                                     bool charts);

/// Only the count of outcomes by peer, as a table.
[[nodiscard]] std::string outcome_table(const std::vector<Front>& fronts);

/// One line a point: engine, setting, seconds, error, hash.
[[nodiscard]] std::string front_csv(const std::vector<Front>& fronts, const PageFacts& facts);

}  // namespace lockstone::bench
