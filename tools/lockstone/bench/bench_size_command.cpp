#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/bench/size/size_run.h"
#include "tools/bench/support/measure.h"
#include "tools/lockstone/bench/print/bench_size_print.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/options.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

constexpr std::uint32_t k_smallest_world = 100;
constexpr std::uint32_t k_largest_world = 1'000'000;

struct BenchSizeOptions {
  std::vector<std::string> kinds;  // none: all
  std::uint32_t most = k_largest_world;
  bool cpu = false;
  bool json = false;
  std::string vectors;  // empty: the widest
  std::string page;
  std::string chart;
  bool force = false;

  [[nodiscard]] std::string_view clock_name() const { return cpu ? "thread" : "steady"; }
};

// That makes the same page again, in the place of this one.
std::string command_of(const BenchSizeOptions& options) {
  std::string command = "lockstone bench size";
  if (!options.kinds.empty()) command += fmt::format(" --kinds {}", fmt::join(options.kinds, ","));
  command += fmt::format(" --most {}", options.most);
  if (options.cpu) command += " --cpu";
  if (!options.vectors.empty()) command += fmt::format(" --vectors {}", options.vectors);
  if (!options.chart.empty()) command += fmt::format(" --chart {}", options.chart);
  return command + fmt::format(" --page {} --force", options.page);
}

// Powers of ten, and the largest that the kind has.
std::vector<std::uint32_t> sizes_of(const bench::SizeKind& kind, std::uint32_t most) {
  std::vector<std::uint32_t> sizes;
  most = std::min(most, kind.most_bodies);
  for (std::uint32_t bodies = k_smallest_world; bodies < most; bodies *= 10)
    sizes.push_back(bodies);
  sizes.push_back(most);
  return sizes;
}

std::vector<bench::SizeFigures> measure(const BenchSizeOptions& options) {
  std::vector<bench::SizeFigures> all;
  Progress progress;
  for (const bench::SizeKind& kind : bench::size_kinds()) {
    if (!options.kinds.empty() && std::ranges::count(options.kinds, kind.name) == 0) continue;
    for (const std::uint32_t bodies : sizes_of(kind, options.most)) {
      progress.show(fmt::format("{}, {} bodies", kind.name, bodies));
      all.push_back(bench::measure_size(
          kind, bodies, options.cpu ? bench::thread_nanoseconds : bench::now_nanoseconds));
      progress.clear();
      if (!options.json) fmt::print("{}", size_line(all.back()));
      std::fflush(stdout);
    }
  }
  return all;
}

bool write_files(const BenchSizeOptions& options, const std::vector<bench::SizeFigures>& all) {
  const std::string chart = std::filesystem::path(options.chart).filename().string();
  return (options.chart.empty() ||
          write_text_file({options.chart, options.force}, size_sheet(all))) &&
         (options.page.empty() ||
          write_text_file({options.page, options.force},
                          size_page(all, options.clock_name(), command_of(options), chart)));
}

int run(const BenchSizeOptions& options) {
  for (const std::string& name : options.kinds) {
    if (bench::find_size_kind(name) != nullptr) continue;
    complain(fmt::format("no kind of world is named {}", name));
    return k_usage;
  }
  if (!use_vectors(options.vectors)) return k_usage;
  if (!may_write({options.page, options.force}) || !may_write({options.chart, options.force}))
    return k_unavailable;
  if (!options.json) fmt::print("{}", size_head(options.clock_name()));
  const std::vector<bench::SizeFigures> all = measure(options);
  if (options.json) print_size_json(all, options.clock_name());
  if (!write_files(options, all)) return k_unavailable;
  for (const bench::SizeFigures& size : all)
    if (!size.had_room)
      complain(
          fmt::format("{}, {} bodies: a tick did not do all of its work", size.kind, size.bodies));
  return std::ranges::all_of(all, &bench::SizeFigures::had_room) ? k_ok : k_different;
}

}  // namespace

void add_bench_size_command(CLI::App& bench, int& exit_code) {
  auto options = std::make_shared<BenchSizeOptions>();
  CLI::App* command =
      bench.add_subcommand("size", "Time and memory of worlds of a hundred to a million bodies");
  command->add_option("--kinds", options->kinds, "Only these: asleep, stacks, pile, ragdolls")
      ->delimiter(',');
  command->add_option("--most", options->most, "Bodies of the largest world")
      ->check(CLI::Range(k_smallest_world, k_largest_world))
      ->capture_default_str();
  add_vectors_option(*command, options->vectors);
  command->add_flag("--cpu", options->cpu,
                    "Count only the time that the stepping thread itself ran");
  command->add_flag("--json", options->json, "Print JSON");
  command->add_option("--page", options->page, "Also write the table into a file *.md");
  command->add_option("--chart", options->chart, "Also draw it into a file *.svg");
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace lockstone::tool
