#include <utility>

#include <lockstone/replay/seek.h>

#include "replay/verifying/verification.h"

namespace lockstone::replay {

std::string_view to_string(SeekFrom from) {
  if (from == SeekFrom::keyframe) return "keyframe";
  return from == SeekFrom::beginning ? "beginning" : "unknown";
}
namespace {

SeekResult failed(Status status, std::string what) {
  SeekResult result;
  result.status = status;
  result.what = std::move(what);
  return result;
}

SeekResult refused(const TickReader& ticks, Status status) {
  const Damage& damage = ticks.reader().damage();
  return failed(status, damage.what.empty() ? std::string(to_string(status)) : damage.what);
}

// None: the beginning of the match.
std::optional<KeyframePlace> start_of(Source& source, std::uint64_t tick, SeekFrom from) {
  Result<KeyframePlace> place = find_keyframe(source, tick);
  if (from == SeekFrom::keyframe) {
    return place ? std::optional(place.value()) : std::nullopt;
  }
  const LogMap map = map_log(source);
  LogReader reader(source);
  if (reader.open() != Status::ok || map.keyframes.empty()) return std::nullopt;
  const KeyframePlace first = map.keyframes.front();
  const std::uint64_t start_tick = reader.header().match.start_tick;
  return start_tick > 0 && first.tick <= tick ? std::optional(first) : std::nullopt;
}

// The field of the header that keeps the log from being stepped at all. Another canary does not: it
// says that hashes will differ, and the caller looks for the tick where they do.
std::optional<FieldMismatch> obstacle(const SimulationInfo& log, const SimulationInfo& here) {
  SimulationInfo comparable = here;
  comparable.canary = log.canary;
  const std::vector<FieldMismatch> mismatches = compare_info(log, comparable);
  return mismatches.empty() ? std::nullopt : std::optional(mismatches.front());
}

// Makes the simulation and compares it with the log's header.
SeekResult create(const SimulationFactory& factory, const TickReader& ticks) {
  Result<std::unique_ptr<Simulation>> made = factory(ticks.config());
  if (!made || made.value() == nullptr) {
    return failed(Status::incompatible, "the simulation refuses the configuration");
  }
  const std::optional<FieldMismatch> field =
      obstacle(ticks.reader().header().info, made.value()->info());
  if (field) {
    return failed(Status::incompatible,
                  field->field + ' ' + field->log + " in the log, " + field->here + " here");
  }
  SeekResult result;
  result.same_canary = made.value()->info().canary == ticks.reader().header().info.canary;
  result.simulation = std::move(made).value();
  return result;
}

// Steps to `tick`. The reader reads a tick ahead only when it is stepped too.
void step_to(SeekResult& result, std::uint64_t tick) {
  Simulation& simulation = *result.simulation;
  while (simulation.tick() < tick) {
    if (!result.ticks->next()) {
      result.status = Status::not_found;
      result.what = "the log ends at tick " + std::to_string(simulation.tick());
      return;
    }
    step_tick(simulation, result.ticks->inputs(), result.ticks->commands());
    if (result.diverged || simulation.hash() == result.ticks->hash()) continue;
    result.diverged = true;
    result.diverged_tick = result.ticks->tick();
  }
}

}  // namespace

SeekResult seek(Source& source, const SimulationFactory& factory, std::uint64_t tick,
                SeekFrom from) {
  const std::optional<KeyframePlace> place = start_of(source, tick, from);
  auto ticks = std::make_unique<TickReader>(source);
  const Status status = ticks->open(place);
  if (status != Status::ok) return refused(*ticks, status);
  if (!place && ticks->reader().header().match.start_tick > 0) {
    return failed(Status::not_found, "the log begins later");
  }
  SeekResult result = create(factory, *ticks);
  if (result.status != Status::ok) return result;
  ticks->bound_snapshots(result.simulation->snapshot_bytes_max(SnapshotKind::canonical));
  if (place) {
    if (!ticks->read_keyframe()) return refused(*ticks, ticks->reader().damage().status);
    const Status loaded = result.simulation->load(SnapshotKind::canonical, ticks->snapshot());
    if (loaded != Status::ok) return failed(loaded, "the simulation refuses the keyframe");
  }
  result.loaded_tick = result.simulation->tick();
  result.ticks = std::move(ticks);
  step_to(result, tick);
  return result;
}

}  // namespace lockstone::replay
