#include "tools/lockstone/bench/print/bench_instructions.h"

#include <algorithm>

#include <fmt/format.h>

#include "tools/bench/speed/instructions.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

using bench::InstructionCount;

constexpr double k_allowed_growth = 0.02;
constexpr std::uint32_t k_share_of_ticks = 100, k_least_ticks = 3;

bool can_count() {
  if (bench::can_count_instructions()) return true;
  complain("counting instructions needs valgrind");
  return false;
}

std::vector<InstructionCount> count_all(const std::vector<InstructionCount>& wanted) {
  std::vector<InstructionCount> counts;
  Progress progress;
  for (const InstructionCount& want : wanted) {
    progress.show(want.scene);
    if (const auto count = bench::count_instructions(want.scene, want.ticks))
      counts.push_back(*count);
    else
      complain(fmt::format("{}: cannot be counted", want.scene));
  }
  return counts;
}

double growth_of(const InstructionCount& before, const InstructionCount& now) {
  return static_cast<double>(now.instructions) / static_cast<double>(before.instructions) - 1;
}

void print_growth(const InstructionCount& before, const InstructionCount& now) {
  const double growth = growth_of(before, now);
  const char* verdict = growth > k_allowed_growth    ? "WORSE"
                        : growth < -k_allowed_growth ? "better"
                                                     : "same";
  fmt::print("{:<16} {:>5} {:>15} {:>15} {:>+8.2f} %  {}{}\n", now.scene, now.ticks,
             before.instructions / before.ticks, now.instructions / now.ticks, 100 * growth,
             verdict, now.hash == before.hash ? "" : ", another result");
}

}  // namespace

int write_instructions(const std::vector<const bench::SpeedScene*>& scenes, std::uint32_t ticks,
                       const Output& output) {
  if (!can_count()) return k_unavailable;
  std::vector<InstructionCount> wanted;
  for (const bench::SpeedScene* scene : scenes) {
    const std::uint32_t share = std::max(scene->ticks / k_share_of_ticks, k_least_ticks);
    wanted.push_back({std::string(scene->name), ticks != 0 ? ticks : share, 0, {}});
  }
  const std::vector<InstructionCount> counts = count_all(wanted);
  if (!write_text_file(output, bench::counts_to_csv(counts))) return k_unavailable;
  return counts.size() == wanted.size() ? k_ok : k_different;
}

int compare_instructions(const std::string& path) {
  const auto text = read_file(path);
  const std::vector<InstructionCount> before =
      text ? bench::counts_from_csv(*text) : std::vector<InstructionCount>{};
  if (before.empty()) {
    complain(fmt::format("{}: no counts", path));
    return k_corrupt;
  }
  if (!can_count()) return k_unavailable;
  const std::vector<InstructionCount> counts = count_all(before);
  fmt::print("{:<16} {:>5} {:>15} {:>15} {:>10}\n", "scene", "ticks", "before, a tick",
             "now, a tick", "growth");
  int code = counts.size() == before.size() ? k_ok : k_different;
  for (const InstructionCount& now : counts) {
    const InstructionCount& then = *std::ranges::find(before, now.scene, &InstructionCount::scene);
    print_growth(then, now);
    if (growth_of(then, now) > k_allowed_growth) code = k_different;
  }
  return code;
}

}  // namespace lockstone::tool
