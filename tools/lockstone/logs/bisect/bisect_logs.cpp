#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/seek.h>

#include "tools/lockstone/logs/bisect/bisect.h"
#include "tools/lockstone/logs/bisect/stage_trace.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/lockstone/logs/state/canonical_fields.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

// One log, stepped through the tick at which the two part.
struct Side {
  std::string path;
  GameLog log;
  replay::SeekResult found;
  StageTrace stages{};
  bool reproduced = false;  // this build computes the hash that was recorded

  [[nodiscard]] bool step_through(std::uint64_t tick) {
    found = replay::seek(*log.source, log.game->make, tick);
    if (found.status == Status::ok && !found.ticks->next()) found.status = Status::not_found;
    if (found.status != Status::ok) {
      complain(fmt::format("{}: {}", path, found.what));
      return false;
    }
    stages = step_traced(*log.game, *found.simulation, *found.ticks);
    reproduced = found.simulation->hash() == found.ticks->hash();
    return true;
  }

  // Steps on to the log's next keyframe: a whole state that this build does not compute.
  [[nodiscard]] bool step_to_keyframe() {
    while (found.ticks->next()) {
      if (found.ticks->at_keyframe()) return true;
      step_tick(*found.simulation, found.ticks->inputs(), found.ticks->commands());
    }
    return found.ticks->at_keyframe();
  }
};

// Notes down both states, and describes their difference.
void note_states(const Simulation& simulation, std::vector<std::byte> here,
                 std::vector<std::byte> there, BisectReport& report) {
  report.difference = simulation.describe(here, there);
  report.difference_tick = simulation.tick();
  report.state_here = std::move(here);
  report.state_there = std::move(there);
}

// The same with the sides in their order: `is_here` says that `recorded` is the first.
void note_sides(const Simulation& simulation, std::vector<std::byte> recorded,
                std::vector<std::byte> computed, bool is_here, BisectReport& report) {
  if (!is_here) std::swap(recorded, computed);
  note_states(simulation, std::move(recorded), std::move(computed), report);
}

// Looks for one flipped bit of the state behind the tick that explains the recorded hash.
bool blame_one_bit(Side& odd, bool is_here, BisectReport& report) {
  Simulation& simulation = *odd.found.simulation;
  std::vector<std::byte> computed = canonical_bytes(simulation);
  std::vector<std::byte> flipped =
      find_flipped_bit(*odd.log.game, simulation, odd.found.ticks->hash());
  if (flipped.empty()) return false;
  note_sides(simulation, std::move(flipped), std::move(computed), is_here, report);
  report.note += "; its hash is that of the state here with this one bit flipped";
  return true;
}

// Both inputs were equal and so are the states here: one of the logs was made by something else.
void blame(Side& here, Side& there, BisectReport& report) {
  Side& odd = here.reproduced ? there : here;
  const bool is_here = &odd == &here;
  report.note = here.reproduced || there.reproduced
                    ? fmt::format(
                          "this build comes to the hash of {}; {} was made by another "
                          "build, or a fault",
                          (is_here ? there : here).path, odd.path)
                    : std::string("this build comes to another hash than both");
  if (blame_one_bit(odd, is_here, report)) return;
  if (!odd.step_to_keyframe()) {
    report.note += "; no keyframe after the tick says more";
    return;
  }
  const ByteView recorded = odd.found.ticks->snapshot();
  note_sides(*odd.found.simulation, {recorded.begin(), recorded.end()},
             canonical_bytes(*odd.found.simulation), is_here, report);
  report.note += "; the field is that of its next keyframe";
}

void explain(Side& here, Side& there, BisectReport& report) {
  const Simulation& simulation = *here.found.simulation;
  if (simulation.hash() == there.found.simulation->hash()) return blame(here, there, report);
  report.stage = first_difference(here.stages, there.stages);
  note_states(simulation, canonical_bytes(simulation), canonical_bytes(*there.found.simulation),
              report);
}

// Builds that compute different results fail each other's canary, and bisecting them must still
// work.
bool are_of_one_match(const replay::LogComparison& logs) {
  const auto stands_in_the_way = [](const replay::FieldMismatch& field) {
    return field.field != "canary";
  };
  return logs.same_config &&
         std::none_of(logs.header.begin(), logs.header.end(), stands_in_the_way);
}

BisectReport logs_failed(int exit_code) {
  BisectReport report;
  report.exit_code = exit_code;
  return report;
}

}  // namespace

BisectReport bisect_logs(const Games& games, const std::string& here_path,
                         const std::string& there_path) {
  Side here{.path = here_path, .log = open_game_log(games, here_path), .found = {}, .stages = {}};
  Side there{
      .path = there_path, .log = open_game_log(games, there_path), .found = {}, .stages = {}};
  for (const Side* side : {&here, &there})
    if (side->log.source == nullptr) return logs_failed(side->log.exit_code);
  const replay::LogComparison comparison =
      replay::compare_logs(*here.log.source, *there.log.source);
  if (!are_of_one_match(comparison)) {
    complain("the logs are of different simulations or configurations; see `lockstone diff`");
    return logs_failed(k_incompatible);
  }
  if (comparison.status != Status::ok && comparison.status != Status::truncated) {
    complain(comparison.what);
    return logs_failed(exit_code_of(comparison.status));
  }
  BisectReport report;
  const std::optional<std::uint64_t> tick = comparison.first_difference();
  if (!tick) return report;
  report.exit_code = k_different;
  report.found = true;
  report.tick = *tick;
  if (!here.step_through(*tick) || !there.step_through(*tick)) return logs_failed(k_incompatible);
  explain(here, there, report);
  if (comparison.input && comparison.input->tick == *tick) {
    report.note =
        fmt::format("the inputs of player {} differ in this tick", comparison.input->slot);
  }
  return report;
}

}  // namespace lockstone::tool
