#include "tools/bench/charts/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace lockstone::bench {
namespace {

constexpr double k_width = 640, k_height = 400;
constexpr double k_left = 74, k_right = 150, k_top = 34, k_bottom = 50;
constexpr int k_most_ticks = 7;  // of an axis

// Told apart by most who see colours differently (M. Okabe, K. Ito, "Color universal design").
constexpr std::array<std::string_view, 7> k_colours{"#d55e00", "#0072b2", "#009e73", "#56b4e9",
                                                    "#cc79a7", "#e69f00", "#444444"};

// An axis in decades.
struct Axis {
  double low = 0, high = 0;  // powers of ten
  double from = 0, to = 0;   // pixels

  [[nodiscard]] double at(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
  }
  [[nodiscard]] int tick_step() const {
    return std::max(1, static_cast<int>(std::ceil((high - low) / k_most_ticks)));
  }
};

Axis axis_over(const std::vector<double>& values, double from, double to) {
  const auto [least, most] = std::ranges::minmax(values);
  Axis axis{std::floor(std::log10(least) - 0.05), std::ceil(std::log10(most) + 0.05), from, to};
  if (axis.high - axis.low < 2) axis.low -= 1;
  return axis;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text)
    result += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return result;
}

std::string text_at(double x, double y, std::string_view anchor, int size, std::string_view text,
                    std::string_view more = "") {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\" {}>{}</text>\n", x, y,
      anchor, size, more, escaped(text));
}

std::string line_between(double x0, double y0, double x1, double y1, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x0, y0,
                     x1, y1, style);
}

std::string power_text(int power) {
  return power >= -2 && power <= 3 ? fmt::format("{:g}", std::pow(10.0, power))
                                   : fmt::format("1e{}", power);
}

// Within decades, where there are few of them.
std::vector<double> fine_ticks(const Axis& axis) {
  std::vector<double> ticks;
  if (axis.high - axis.low > 4) return ticks;
  for (int p = static_cast<int>(axis.low); p < static_cast<int>(axis.high); ++p) {
    for (const double digit : {2.0, 5.0})
      ticks.push_back(digit * std::pow(10.0, p));
  }
  return ticks;
}

struct Frame {
  Axis x, y;

  [[nodiscard]] std::string grid() const {
    constexpr std::string_view k_fine = "stroke=\"#e8e8e8\"", k_coarse = "stroke=\"#c4c4c4\"";
    std::string svg;
    for (const double tick : fine_ticks(x)) {
      svg += line_between(x.at(tick), y.from, x.at(tick), y.to, k_fine);
      svg += text_at(x.at(tick), y.from + 14, "middle", 9, fmt::format("{:.0e}", tick).substr(0, 1));
    }
    for (int p = static_cast<int>(x.low); p <= static_cast<int>(x.high); ++p) {
      const bool named = (p - static_cast<int>(x.low)) % x.tick_step() == 0;
      const double at = x.at(std::pow(10.0, p));
      svg += line_between(at, y.from, at, y.to, named ? k_coarse : k_fine);
      if (named) svg += text_at(at, y.from + 17, "middle", 12, power_text(p));
    }
    for (int p = static_cast<int>(y.low); p <= static_cast<int>(y.high); ++p) {
      const bool named = (p - static_cast<int>(y.low)) % y.tick_step() == 0;
      const double at = y.at(std::pow(10.0, p));
      svg += line_between(x.from, at, x.to, at, named ? k_coarse : k_fine);
      if (named) svg += text_at(x.from - 7, at + 4, "end", 12, power_text(p));
    }
    return svg + fmt::format(
                     "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                     "fill=\"none\" stroke=\"#333\"/>\n",
                     x.from, y.to, x.to - x.from, y.from - y.to);
  }
};

Frame frame_of(const Chart& chart) {
  std::vector<double> xs, ys;
  for (const ChartLine& line : chart.lines) {
    for (const ChartPoint& point : line.points) {
      xs.push_back(point.x);
      ys.push_back(point.y);
    }
  }
  if (chart.goal > 0) ys.push_back(chart.goal);
  if (xs.empty()) xs = {1};
  if (ys.empty()) ys = {1};
  return {axis_over(xs, k_left, k_width - k_right), axis_over(ys, k_height - k_bottom, k_top)};
}

std::string_view colour_of(const ChartLine& line) {
  return k_colours[static_cast<std::size_t>(line.colour) % k_colours.size()];
}

std::string stroke_of(const ChartLine& line) {
  return fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}", colour_of(line), line.bold ? 2.6 : 1.6,
                     line.dashed ? " stroke-dasharray=\"6 4\"" : "");
}

std::string marker(const ChartLine& line, double x, double y) {
  if (line.dashed)
    return fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" height=\"7\" fill=\"#fff\" "
        "stroke=\"{}\" stroke-width=\"1.6\"/>\n",
        x - 3.5, y - 3.5, colour_of(line));
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y,
                     line.bold ? 4.5 : 3.5, colour_of(line));
}

std::string drawn(const ChartLine& line, const Frame& frame) {
  std::string path, markers;
  for (const ChartPoint& point : line.points) {
    const double x = frame.x.at(point.x), y = frame.y.at(point.y);
    path += fmt::format("{:.1f},{:.1f} ", x, y);
    markers += marker(line, x, y);
    markers +=
        text_at(x + 6, y - 6, "start", 9, point.label, fmt::format("fill=\"{}\"", colour_of(line)));
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n{}", path, stroke_of(line),
                     markers);
}

std::string legend(const Chart& chart) {
  std::string svg;
  double y = k_top + 8;
  const double x = k_width - k_right + 12;
  for (const ChartLine& line : chart.lines) {
    svg += line_between(x, y, x + 26, y, stroke_of(line));
    svg += marker(line, x + 13, y);
    svg += text_at(x + 32, y + 4, "start", 12, line.name);
    y += 19;
  }
  if (chart.goal > 0) {
    svg += line_between(x, y, x + 26, y, "stroke=\"#999\" stroke-dasharray=\"2 3\"");
    svg += text_at(x + 32, y + 4, "start", 12, fmt::format("goal {:g}", chart.goal));
  }
  return svg;
}

std::string body_of(const Chart& chart) {
  const Frame frame = frame_of(chart);
  std::string svg = text_at(k_left, 21, "start", 15, chart.title, "font-weight=\"bold\"");
  svg += frame.grid();
  if (chart.goal > 0) {
    const double y = frame.y.at(chart.goal);
    svg += line_between(frame.x.from, y, frame.x.to, y, "stroke=\"#999\" stroke-dasharray=\"2 3\"");
  }
  for (const ChartLine& line : chart.lines)
    svg += drawn(line, frame);
  svg += text_at((frame.x.from + frame.x.to) / 2, k_height - 12, "middle", 13, chart.x_label);
  const double middle = (frame.y.from + frame.y.to) / 2;
  svg += text_at(18, middle, "middle", 13, chart.y_label,
                 fmt::format("transform=\"rotate(-90 18 {:.1f})\"", middle));
  return svg + legend(chart);
}

std::string document(double width, double height, const std::string& content) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 "
      "0 "
      "{0:.0f} {1:.0f}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{2}</svg>\n",
      width, height, content);
}

}  // namespace

std::string svg_of(const Chart& chart) {
  return document(k_width, k_height, body_of(chart));
}

std::string svg_sheet(std::span<const Chart> charts, int columns) {
  std::string content;
  const int count = static_cast<int>(charts.size());
  for (int i = 0; i < count; ++i)
    content +=
        fmt::format("<g transform=\"translate({:.0f} {:.0f})\">\n{}</g>\n", k_width * (i % columns),
                    k_height * (i / columns), body_of(charts[static_cast<std::size_t>(i)]));
  const int rows = (count + columns - 1) / columns;
  return document(k_width * std::min(columns, count), k_height * rows, content);
}

}  // namespace lockstone::bench
