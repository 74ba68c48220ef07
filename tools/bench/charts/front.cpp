#include "tools/bench/charts/front.h"

#include <algorithm>

#include <fmt/format.h>

namespace lockstone::bench {
namespace {

bool is_ours(const FrontLine& line) {
  return line.engine->name.starts_with(k_ours);
}

FrontLine line_of(const JudgedError& error, const EngineRuns& engine) {
  const NeutralScene* scene = find_neutral_scene(error.scene);
  FrontLine line{&engine, {}};
  for (const Played& played : engine.runs) {
    if (played.scene == error.scene)
      line.points.push_back(
          {played.setting, played.median_seconds(), judge(error, *scene, played)});
  }
  std::ranges::sort(line.points, {}, &FrontPoint::setting);
  return line;
}

// Our line of a family; null for none.
const FrontLine* our_line(const Front& front, std::string_view family) {
  const auto found = std::ranges::find_if(front.lines, [&](const FrontLine& line) {
    return is_ours(line) && line.engine->family == family;
  });
  return found == front.lines.end() ? nullptr : &*found;
}

// Our least error in no more time than that.
FrontPoint best_within(const FrontLine& ours, double seconds) {
  FrontPoint best;
  for (const FrontPoint& point : ours.points) {
    const bool first = best.seconds == 0;
    if (point.seconds <= seconds && (first || point.error < best.error)) best = point;
  }
  return best;
}

Verdict verdict_of(const FrontLine& ours, const FrontLine& peer, bool timed) {
  constexpr double k_any_time = 1e300;
  Verdict verdict{&peer, Outcome::behind, 0, 0, {}, {}, timed};
  bool best_is_beaten = false;
  for (const FrontPoint& point : peer.points) {
    const FrontPoint our = best_within(ours, timed ? point.seconds : k_any_time);
    const bool better = our.seconds > 0 && our.error <= point.error;
    verdict.better += better ? 1 : 0;
    if (verdict.points++ == 0 || point.error < verdict.best.error) {
      verdict.best = point;
      verdict.ours = our;
      best_is_beaten = better;
    }
  }
  if (verdict.better == verdict.points)
    verdict.outcome = Outcome::ahead;
  else if (verdict.better > 0)
    verdict.outcome = best_is_beaten ? Outcome::ahead_at_best : Outcome::behind_at_best;
  return verdict;
}

int colour_of(std::string_view engine) {
  constexpr std::string_view k_names[] = {k_ours, "Bullet", "ODE", "ODE direct", "Rapier", "Jolt"};
  const auto found = std::ranges::find_if(k_names, [&](std::string_view name) {
    return engine == name || (name == k_ours && engine.starts_with(name));
  });
  return static_cast<int>(found - std::begin(k_names));
}

}  // namespace

std::string_view name_of(Outcome outcome) {
  constexpr std::string_view k_names[] = {"ahead", "ahead at its best", "behind at its best",
                                          "behind"};
  return k_names[static_cast<std::size_t>(outcome)];
}

std::vector<Front> fronts_of(const std::vector<EngineRuns>& engines) {
  std::vector<Front> fronts;
  for (const JudgedError& error : judged_errors()) {
    Front front{&error, {}};
    for (const EngineRuns& engine : engines) {
      FrontLine line = line_of(error, engine);
      if (!line.points.empty()) front.lines.push_back(std::move(line));
    }
    if (!front.lines.empty()) fronts.push_back(std::move(front));
  }
  return fronts;
}

std::vector<Verdict> verdicts_of(const Front& front) {
  std::vector<Verdict> verdicts;
  for (const FrontLine& peer : front.lines) {
    if (is_ours(peer)) continue;
    const FrontLine* ours = our_line(front, peer.engine->family);
    const bool timed = ours != nullptr;
    if (!timed) ours = our_line(front, "native");
    if (ours != nullptr) verdicts.push_back(verdict_of(*ours, peer, timed));
  }
  return verdicts;
}

Chart chart_of(const Front& front) {
  const JudgedError& error = *front.error;
  Chart chart{std::string(error.title),
              "CPU time, s a simulated second",
              fmt::format("error, {}", error.unit),
              error.goal,
              {}};
  if (error.row > 0) chart.title = fmt::format("Row {}: {}", error.row, error.title);
  for (const FrontLine& line : front.lines) {
    ChartLine& drawn = chart.lines.emplace_back();
    drawn.name = line.engine->name;
    drawn.colour = colour_of(drawn.name);
    drawn.dashed = line.engine->family != "native";
    drawn.bold = is_ours(line);
    for (const FrontPoint& point : line.points)
      drawn.points.push_back({point.seconds, point.error, std::to_string(point.setting)});
  }
  return chart;
}

}  // namespace lockstone::bench
