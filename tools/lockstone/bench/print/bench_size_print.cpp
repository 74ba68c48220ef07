#include "tools/lockstone/bench/print/bench_size_print.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/kernels/target.h"
#include "tools/bench/charts/chart.h"
#include "tools/bench/support/machine.h"
#include "tools/lockstone/bench/print/bench_names.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {
namespace {

using bench::SizeFigures;
using Json = nlohmann::ordered_json;

constexpr double k_us = 1e3, k_ms = 1e6, k_s = 1e9;  // ns
constexpr double k_mb = 1e6;                         // bytes

std::string row_of(const SizeFigures& size, std::string_view line) {
  const double bodies = size.bodies;
  return fmt::format(
      fmt::runtime(line), size.kind, size.bodies, size.moving, size.contacts, size.tick_ns / k_ms,
      size.tick_p99_ns / k_ms, size.tick_ns / std::max(size.moving, 1.0) / k_us,
      static_cast<double>(size.heap) / k_mb, static_cast<double>(size.snapshot) / bodies,
      size.make_ns / k_s, size.save_ns / k_ms, size.load_ns / k_ms, size.hash_ns / k_ms,
      size.destroy_ns / k_us, size.highest, hash_text(size.hash));
}

using Value = double (*)(const SizeFigures& size);

bench::Chart chart_of(std::span<const SizeFigures> all, std::string title, std::string unit,
                      Value value) {
  bench::Chart chart{std::move(title), "bodies", std::move(unit), 0, {}};
  for (const SizeFigures& size : all) {
    if (chart.lines.empty() || chart.lines.back().name != size.kind) {
      const int colour = static_cast<int>(chart.lines.size()) + 1;
      chart.lines.push_back({std::string(size.kind), colour, false, true, {}});
    }
    if (value(size) > 0)
      chart.lines.back().points.push_back(
          {static_cast<double>(size.bodies), value(size), fmt::format("{:.3g}", value(size))});
  }
  return chart;
}

}  // namespace

std::string size_head(std::string_view clock_name) {
  return fmt::format(
      "vectors: {}; clock: {}{}\n{:<8} {:>8} {:>9} {:>9} {:>10} {:>10} {:>9} {:>8} {:>6} {:>7} "
      "{:>8} {:>8} {:>8} {:>7} {:>8}  {}\n",
      lanes::current_target(), clock_name, k_build_remark, "kind", "bodies", "moving", "contacts",
      "ms/tick", "p99", "us/moving", "MB", "B/body", "make s", "save ms", "load ms", "hash ms",
      "destroy", "top m", "final hash");
}

std::string size_line(const SizeFigures& figures) {
  return row_of(figures,
                "{:<8} {:>8} {:>9.0f} {:>9.0f} {:>10.4f} {:>10.4f} {:>9.3f} {:>8.1f} {:>6.0f} "
                "{:>7.2f} {:>8.3f} {:>8.3f} {:>8.3f} {:>7.2f} {:>8.2f}  {}\n");
}

std::string size_page(std::span<const SizeFigures> all, std::string_view clock_name,
                      std::string_view command, std::string_view chart) {
  std::string text = fmt::format(
      "# Cost against size\n\nMade by `{}`; {}; vectors: {}; {}; commit {}; clock: {}.\n\nOne "
      "thread, 60 Hz, 4 substeps. `us a moving body` is the mean of a tick over the bodies that "
      "moved in it, `MB` the memory of a world made for as many, `B a body` its native\nsnapshot; "
      "`hash` is that of the records that one tick changed, `destroy` is for one body by a "
      "command, `top` is "
      "the highest centre at the end, `make` "
      "includes the ticks until all sleep, where they do.",
      command, bench::machine_text(), lanes::current_target(), bench::compiler_text(),
      bench::commit_text(), clock_name);
  if (!chart.empty()) text += fmt::format(" Drawn: [{0}]({0}).", chart);
  text += "\n\n";
  for (const bench::SizeKind& kind : bench::size_kinds())
    text += fmt::format("- `{}`: {}; {} ticks.\n", kind.name, kind.text, kind.ticks);
  text +=
      "\n| kind | bodies | moving | contacts | ms a tick | p99 | us a moving body | MB | B a body "
      "| "
      "make, s | save, ms | load, ms | hash, ms | destroy, us | top, m | final hash |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SizeFigures& size : all)
    text += row_of(size,
                   "| {} | {} | {:.0f} | {:.0f} | {:.4f} | {:.4f} | {:.3f} | {:.1f} | {:.0f} | "
                   "{:.2f} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | `{}` |\n");
  return text;
}

std::string size_sheet(std::span<const SizeFigures> all) {
  const bench::Chart charts[] = {
      chart_of(all, "a tick", "ms", [](const SizeFigures& size) { return size.tick_ns / k_ms; }),
      chart_of(all, "memory of the world", "MB",
               [](const SizeFigures& size) { return static_cast<double>(size.heap) / k_mb; }),
      chart_of(all, "a native snapshot loaded", "ms",
               [](const SizeFigures& size) { return size.load_ns / k_ms; }),
  };
  return bench::svg_sheet(charts, static_cast<int>(std::size(charts)));
}

void print_size_json(std::span<const SizeFigures> all, std::string_view clock_name) {
  Json json{{"vectors", lanes::current_target()},
            {"asserts", k_asserts},
            {"clock", clock_name},
            {"sizes", Json::array()}};
  for (const SizeFigures& size : all)
    json["sizes"].push_back({{"kind", size.kind},
                             {"bodies", size.bodies},
                             {"ticks", size.ticks},
                             {"moving", size.moving},
                             {"contacts", size.contacts},
                             {"tick_ns", {{"mean", size.tick_ns}, {"p99", size.tick_p99_ns}}},
                             {"heap_bytes", size.heap},
                             {"snapshot_bytes", size.snapshot},
                             {"make_ns", size.make_ns},
                             {"save_ns", size.save_ns},
                             {"load_ns", size.load_ns},
                             {"hash_ns", size.hash_ns},
                             {"destroy_ns", size.destroy_ns},
                             {"highest_m", size.highest},
                             {"had_room", size.had_room},
                             {"hash", hash_text(size.hash)}});
  write_json(json);
}

}  // namespace lockstone::tool
