// Claims that a scene pays only for the features it uses, each with a figure.
#pragma once

#include <string>
#include <vector>

namespace lockstone::bench {

/// One line. Times depend on the machine; counters and sizes do not.
struct SkipFigure {
  std::string claim;
  std::string figure;  ///< the measured quantity
  std::string unit;
  double value = 0;
  double goal = 0;
  bool at_least = false;  ///< the goal is a lower bound
  bool is_time = false;

  [[nodiscard]] bool met() const { return at_least ? value >= goal : value <= goal; }
};

struct SkipOptions {
  bool times = true;  ///< false: counters and sizes alone
};

/// All lines, in the order of the table.
[[nodiscard]] std::vector<SkipFigure> measure_skips(const SkipOptions& options);

}  // namespace lockstone::bench
