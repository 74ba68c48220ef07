#include "tools/bench/charts/page.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace lockstone::bench {
namespace {

struct Tally {
  std::string peer;
  bool timed = true;
  std::array<int, k_outcomes> outcomes{};
};

std::vector<Tally> tallies_of(const std::vector<Front>& fronts) {
  std::vector<Tally> tallies;
  for (const Front& front : fronts) {
    for (const Verdict& verdict : verdicts_of(front)) {
      const std::string& name = verdict.peer->engine->name;
      auto found = std::ranges::find(tallies, name, &Tally::peer);
      if (found == tallies.end()) found = tallies.insert(found, {name, verdict.timed, {}});
      ++found->outcomes[static_cast<std::size_t>(verdict.outcome)];
    }
  }
  return tallies;
}

std::string tally_row(std::string_view name, const std::array<int, k_outcomes>& n) {
  return fmt::format("| {} | {} | {} | {} | {} | {} : {} |\n", name, n[0], n[1], n[2], n[3],
                     n[0] + n[1], n[2] + n[3]);
}

std::string time_text(double seconds) {
  return seconds < 1e-3 ? fmt::format("{:.3g} µs", seconds * 1e6)
                        : fmt::format("{:.3g} ms", seconds * 1e3);
}

std::string error_text(double error) {
  if (error >= k_lost) return "lost";
  return error <= k_least_error ? "≤ 1e-9" : fmt::format("{:.2g}", error);
}

std::string point_text(const FrontPoint& point) {
  return point.seconds == 0 ? std::string("none so fast")
                            : fmt::format("{} in {} ({})", error_text(point.error),
                                          time_text(point.seconds), point.setting);
}

std::string table_of(const Front& front) {
  std::string text =
      "| peer | verdict | at its points | its best | ours |\n"
      "|---|---|---|---|---|\n";
  for (const Verdict& verdict : verdicts_of(front)) {
    text +=
        fmt::format("| {} | {}{} | {} of {} | {} | {} |\n", verdict.peer->engine->name,
                    name_of(verdict.outcome), verdict.timed ? "" : ", error alone", verdict.better,
                    verdict.points, point_text(verdict.best), point_text(verdict.ours));
  }
  return text;
}

std::string head_of(const PageFacts& facts) {
  std::string text = fmt::format("# Run time against error\n\nMade by `{}`; {}; {}; commit {}.\n\n",
                                 facts.command, facts.machine, facts.compiler, facts.commit);
  text +=
      "Each scene is the same description for every engine, each error is found by the same judge. "
      "Time is the processor time of one\nsimulated second, the median of the repeats. In brackets "
      "the setting: substeps (lockstone), steps a tick (Bullet, ODE), solver\niterations (Rapier), "
      "collision steps (Jolt). *Ahead*: at every point of the peer we err no more in no more time; "
      "*ahead at its\nbest*: at its least error, but not at every faster point; *behind at its "
      "best*: "
      "only at other points; *behind*: at none. The last column is our least error in no more time "
      "than its best, or at any time. Errors\nbelow 1e-9 count as equal; *lost* is an "
      "error "
      "above 1000, or none that is a number.\n";
  if (!facts.states.empty()) text += fmt::format("\n{}.\n", facts.states);
  for (const std::string& absent : facts.absent)
    text += fmt::format("\nAbsent: {}.\n", absent);
  return text;
}

std::string csv_of(const JudgedError& error, const FrontLine& line) {
  std::string text;
  for (const FrontPoint& point : line.points) {
    const auto run = std::ranges::find_if(line.engine->runs, [&](const Played& played) {
      return played.scene == error.scene && played.setting == point.setting;
    });
    text += fmt::format("{},{},{},{},{},{},{:.4g},{:.4g},{:016x}\n", error.row, error.name,
                        error.unit, line.engine->name, line.engine->family, point.setting,
                        point.seconds, point.error, run->hash);
  }
  return text;
}

}  // namespace

std::string outcome_table(const std::vector<Front>& fronts) {
  std::string text =
      "| peer | ahead | ahead at its best | behind at its best | behind | wins : losses |\n"
      "|---|---|---|---|---|---|\n";
  std::array<int, k_outcomes> sums{};
  for (const Tally& tally : tallies_of(fronts)) {
    text += tally_row(tally.peer + (tally.timed ? "" : " (error alone)"), tally.outcomes);
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] += tally.outcomes[i];
  }
  return text + tally_row("all", sums);
}

std::string front_page(const std::vector<Front>& fronts, const PageFacts& facts, bool charts) {
  std::string text = head_of(facts) + "\n" + outcome_table(fronts);
  for (const Front& front : fronts) {
    const JudgedError& error = *front.error;
    text += fmt::format("\n## {}{}\n\n", error.row > 0 ? fmt::format("Row {}: ", error.row) : "",
                        error.title);
    if (charts) text += fmt::format("![{0}]({0}.svg)\n\n", error.name);
    text += fmt::format("Unit: {}.\n\n", error.unit) + table_of(front);
  }
  return text;
}

std::string front_csv(const std::vector<Front>& fronts, const PageFacts& facts) {
  std::string text = fmt::format("# {}; {}; commit {}; {}\n", facts.machine, facts.compiler,
                                 facts.commit, facts.command);
  text += "row,figure,unit,engine,family,setting,cpu_seconds_per_second,error,hash\n";
  for (const Front& front : fronts) {
    for (const FrontLine& line : front.lines)
      text += csv_of(*front.error, line);
  }
  return text;
}

}  // namespace lockstone::bench
