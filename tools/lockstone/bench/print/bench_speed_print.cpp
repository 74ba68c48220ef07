#include "tools/lockstone/bench/print/bench_speed_print.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/kernels/target.h"
#include "tools/lockstone/bench/print/bench_names.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

constexpr double k_ns_per_ms = 1e6;

// Against the first number of threads of the same scene.
double scaling_of(const SpeedReport& report, const bench::SpeedResult& result) {
  const auto first = std::ranges::find(report.results, result.scene, &bench::SpeedResult::scene);
  return first->sum_of_ticks() / result.sum_of_ticks();
}

void print_overview(const SpeedReport& report) {
  fmt::print("vectors: {}; clock: {}{}\n", lanes::current_target(), report.clock_name,
             k_build_remark);
  fmt::print("{:<14} {:>7} {:>6} {:>8} {:>8} {:>8} {:>8} {:>7} {:>10} {:>8} {:>8}  {:<16}  {}\n",
             "scene", "threads", "bodies", "contacts", "points", "ms/tick", "p99", "scaling",
             "ns/contact", "ns/body", "hash us", "final hash", "status");
  for (const bench::SpeedResult& result : report.results) {
    const StepReport& last = result.reports.back();
    const double time = result.sum_of_ticks();
    fmt::print(
        "{:<14} {:>7} {:>6} {:>8} {:>8} {:>8.3f} {:>8.3f} {:>7.2f} {:>10.0f} {:>8.0f} {:>8.0f}"
        "  {}  {}{}\n",
        result.scene->name, result.threads, result.bodies, last.contacts, last.contact_points,
        result.quantile_of_ticks(0.5) / k_ns_per_ms, result.quantile_of_ticks(0.99) / k_ns_per_ms,
        scaling_of(report, result), per(time, result.sum(&StepReport::contacts)),
        per(time, result.sum(&StepReport::moving_bodies)), result.hash_nanoseconds / 1000,
        hash_text(result.hash), to_string(result.status()),
        result.hashes_agree ? "" : ", HASHES DIFFER");
  }
}

void print_stages(const SpeedReport& report) {
  fmt::print("\nms a tick, mean, and share by stage\n{:<17}", "threads");
  for (const StepStage stage : all_stages())
    fmt::print(" {:>15}", name_of(stage));
  fmt::print("\n");
  for (const bench::SpeedResult& result : report.results) {
    fmt::print("{:<14} {:>2}", result.scene->name, result.threads);
    for (const StepStage stage : all_stages()) {
      const double time = result.sum_of(stage);
      fmt::print(" {:>9.3f} {:>4.0f}%",
                 time / k_ns_per_ms / static_cast<double>(result.times.size()),
                 100 * time / result.sum_of_ticks());
    }
    fmt::print("\n");
  }
}

void print_pairs(const bench::SpeedResult& result, double clock_nanoseconds) {
  fmt::print("\n{}: pairs of shapes, a tick; {:.0f} ns taken off each pair for the clock\n",
             result.scene->name, clock_nanoseconds);
  fmt::print("{:<22} {:>9} {:>8} {:>10} {:>8} {:>8} {:>9} {:>9}\n", "", "pairs", "contact",
             "manifolds", "reused", "by axis", "ns/pair", "ms/tick");
  const auto steps = static_cast<double>(result.detail.steps);
  for (const PairRow& row : pair_rows(result.detail)) {
    const PairProfile& pairs = *row.profile;
    const double time = net_nanoseconds(pairs, clock_nanoseconds);
    fmt::print("{:<22} {:>9.0f} {:>7.0f}% {:>10.0f} {:>7.0f}% {:>7.0f}% {:>9.0f} {:>9.3f}\n",
               row.name, static_cast<double>(pairs.pairs) / steps,
               100 * per(static_cast<double>(pairs.in_contact), pairs.pairs),
               static_cast<double>(pairs.manifolds) / steps,
               100 * per(static_cast<double>(pairs.reused), pairs.manifolds),
               100 * per(static_cast<double>(pairs.parted), pairs.pairs - pairs.in_contact),
               per(time, pairs.pairs), time / steps / k_ns_per_ms);
  }
}

}  // namespace

void print_speed_tables(const SpeedReport& report) {
  print_overview(report);
  if (report.results.empty()) return;
  print_stages(report);
  if (!report.detail) return;
  for (const bench::SpeedResult& result : report.results) {
    if (result.detail.steps > 0) print_pairs(result, report.clock_nanoseconds);
  }
}

std::string speed_csv(const SpeedReport& report) {
  std::string text = "scene,threads,tick,ns";
  for (const StepStage stage : all_stages())
    text += fmt::format(",{}_ns", name_of(stage));
  text += ",moving,pairs,contacts,points,saturations\n";
  for (const bench::SpeedResult& result : report.results) {
    for (std::size_t tick = 0; tick < result.times.size(); ++tick) {
      text += fmt::format("{},{},{},{:.0f}", result.scene->name, result.threads, tick,
                          result.times[tick].whole);
      for (const double stage : result.times[tick].stages)
        text += fmt::format(",{:.0f}", stage);
      const StepReport& step = result.reports[tick];
      text += fmt::format(",{},{},{},{},{}\n", step.moving_bodies, step.pairs, step.contacts,
                          step.contact_points, step.saturations);
    }
  }
  return text;
}

}  // namespace lockstone::tool
