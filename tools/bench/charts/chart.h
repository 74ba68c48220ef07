// Log–log charts as SVG: points joined by lines, with axes, ticks and a legend.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace lockstone::bench {

struct ChartPoint {
  double x = 0;  ///< > 0
  double y = 0;  ///< > 0
  std::string label;
};

struct ChartLine {
  std::string name;
  int colour = 0;  ///< lines of one colour belong together
  bool dashed = false;
  bool bold = false;
  std::vector<ChartPoint> points;
};

struct Chart {
  std::string title;
  std::string x_label;
  std::string y_label;
  double goal = 0;  ///< a level line across; 0: none
  std::vector<ChartLine> lines;
};

[[nodiscard]] std::string svg_of(const Chart& chart);

/// All on one sheet, in this many columns.
[[nodiscard]] std::string svg_sheet(std::span<const Chart> charts, int columns);

}  // namespace lockstone::bench
