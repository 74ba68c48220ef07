#include <memory>
#include <utility>

#include <fmt/format.h>

#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/seek.h>

#include "tools/lockstone/bisect.h"
#include "tools/lockstone/console.h"
#include "tools/lockstone/log_file.h"
#include "tools/lockstone/canonical_bytes.h"
#include "tools/scenes/play.h"

namespace lockstone::tool {
namespace {

// One log, stepped through the tick at which the two part.
struct Side {
  std::string path;
  std::unique_ptr<replay::FileSource> source;
  replay::SeekResult found;
  bool reproduced = false;  // this build computes the hash that was recorded

  [[nodiscard]] bool step_through(std::uint64_t tick) {
    found = replay::seek(*source, scenes::make_simulation, tick);
    if (found.status == Status::ok && !found.ticks->next()) found.status = Status::not_found;
    if (found.status != Status::ok) {
      complain(fmt::format("{}: {}", path, found.what));
      return false;
    }
    found.simulation->step(found.ticks->inputs());
    reproduced = found.simulation->hash() == found.ticks->hash();
    return true;
  }

  // Steps on to the log's next keyframe: what else is known of a state that this build does not
  // compute.
  [[nodiscard]] bool step_to_keyframe() {
    while (found.ticks->next()) {
      if (found.ticks->at_keyframe()) return true;
      found.simulation->step(found.ticks->inputs());
    }
    return found.ticks->at_keyframe();
  }
};

// Both inputs were equal and so are the states here: one of the logs was made by something else.
void blame(Side& here, Side& there, BisectReport& report) {
  Side& odd = here.reproduced ? there : here;
  report.note = fmt::format("this build computes the hash of {}, {}; {} holds another one",
                            here.reproduced ? here.path : there.path,
                            here.reproduced || there.reproduced ? "step by step" : "of neither log",
                            odd.path);
  if (!odd.step_to_keyframe()) {
    report.note += ", and no keyframe after it to compare with";
    return;
  }
  const std::vector<std::byte> computed = canonical_bytes(*odd.found.simulation);
  const ByteView recorded = odd.found.ticks->snapshot();
  report.difference = &odd == &here ? odd.found.simulation->describe(recorded, computed)
                                    : odd.found.simulation->describe(computed, recorded);
  report.difference_tick = odd.found.simulation->tick();
}

void explain(Side& here, Side& there, BisectReport& report) {
  const Simulation& simulation = *here.found.simulation;
  if (simulation.hash() == there.found.simulation->hash()) return blame(here, there, report);
  report.difference =
      simulation.describe(canonical_bytes(simulation), canonical_bytes(*there.found.simulation));
  report.difference_tick = simulation.tick();
}

BisectReport logs_failed(int exit_code) {
  BisectReport report;
  report.exit_code = exit_code;
  return report;
}

}  // namespace

BisectReport bisect_logs(const std::string& here_path, const std::string& there_path) {
  Side here{.path = here_path, .source = open_log(here_path), .found = {}};
  Side there{.path = there_path, .source = open_log(there_path), .found = {}};
  if (here.source == nullptr || there.source == nullptr) return logs_failed(k_corrupt);
  const replay::LogComparison comparison = replay::compare_logs(*here.source, *there.source);
  if (!comparison.header.empty() || !comparison.same_config) {
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
