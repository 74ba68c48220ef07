// Reading and bisecting of logs.
#include <algorithm>

#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/log_info.h>
#include <lockstone/replay/seek.h>
#include <lockstone/replay/source.h>
#include <lockstone/replay/tick_reader.h>
#include <lockstone/replay/verifier.h>

#include "tools/bindings/c/game_handles.h"
#include "tools/bindings/c/log_report.h"

struct lks_log {
  std::vector<std::byte> bytes;  // of a log in memory
  std::unique_ptr<lockstone::replay::Source> source;
  std::unique_ptr<lockstone::replay::TickReader> ticks;
  bool read = false;      // a tick was given
  bool has_next = false;  // the tick that `ticks` stands at was not given yet
};

namespace {

using namespace lockstone;
using namespace lockstone::c;

[[noreturn]] void fail(Status status, std::string what) {
  if (what.empty()) what = to_string(status);
  throw_status(static_cast<lks_status>(status), std::move(what));
}

std::unique_ptr<lks_log> open(std::unique_ptr<lks_log> log) {
  log->ticks = std::make_unique<replay::TickReader>(*log->source);
  const Status status = log->ticks->open();
  if (status != Status::ok) fail(status, log->ticks->reader().damage().what);
  return log;
}

lks_simulation_info raw_of(const SimulationInfo& info) {
  return {info.config_hash, info.scene_hash,   info.canary,     info.abi,
          info.tick_rate,   info.player_count, info.input_bytes};
}

lks_log_info raw_of(const replay::LogInfo& info) {
  lks_log_info raw{};
  raw.complete = info.complete ? 1 : 0;
  raw.torn_tail = info.torn_tail ? 1 : 0;
  raw.damaged = info.damage && !info.torn_tail ? 1 : 0;
  raw.simulation = raw_of(info.header.info);
  raw.match_id = info.header.match.match_id;
  raw.seed = info.header.match.seed;
  raw.start_tick = info.header.match.start_tick;
  raw.ticks = info.ticks;
  raw.last_hash = info.last_hash;
  raw.keyframes = info.keyframe_ticks.size();
  write_text(info.header.match.game, raw.game, sizeof raw.game);
  write_text(info.header.match.game_version, raw.game_version, sizeof raw.game_version);
  write_text(info.header.match.build, raw.build, sizeof raw.build);
  write_text(info.end_reason, raw.end_reason, sizeof raw.end_reason);
  return raw;
}

std::vector<std::byte> canonical_bytes(const Simulation& simulation) {
  std::vector<std::byte> bytes(simulation.snapshot_bytes_max(SnapshotKind::canonical));
  bytes.resize(simulation.save(SnapshotKind::canonical, bytes));
  return bytes;
}

/// One of two logs, stepped through the tick at which they differ.
struct Side {
  replay::SeekResult found;
  std::uint64_t recorded = 0;

  Side(lks_log& log, const Game& game, std::uint64_t tick)
      : found(replay::seek(*log.source, game.make, tick)) {
    if (found.status == Status::ok && !found.ticks->next()) found.status = Status::not_found;
    if (found.status != Status::ok) fail(found.status, found.what);
    recorded = found.ticks->hash();
    step_tick(*found.simulation, found.ticks->inputs(), found.ticks->commands());
  }
  [[nodiscard]] bool reproduced() const { return found.simulation->hash() == recorded; }

  /// Steps on to the log's next keyframe: a state that this build does not compute.
  [[nodiscard]] bool step_to_keyframe() {
    while (found.ticks->next()) {
      if (found.ticks->at_keyframe()) return true;
      step_tick(*found.simulation, found.ticks->inputs(), found.ticks->commands());
    }
    return found.ticks->at_keyframe();
  }
};

/// The states behind the tick differ here too, or the next keyframe of the log that this build does
/// not reproduce shows another state.
StateDifference difference_of(Side& here, Side& there, std::uint64_t& at_tick) {
  const Simulation& simulation = *here.found.simulation;
  at_tick = simulation.tick();
  if (simulation.hash() != there.found.simulation->hash()) {
    return simulation.describe(canonical_bytes(simulation),
                               canonical_bytes(*there.found.simulation));
  }
  Side& odd = here.reproduced() ? there : here;
  if (!odd.step_to_keyframe()) return {};
  at_tick = odd.found.simulation->tick();
  const std::vector<std::byte> computed = canonical_bytes(*odd.found.simulation);
  const ByteView kept = odd.found.ticks->snapshot();
  return &odd == &here ? simulation.describe(kept, computed)
                       : odd.found.simulation->describe(computed, kept);
}

bool of_one_match(const replay::LogComparison& logs) {
  return logs.same_config && std::ranges::all_of(logs.header, [](const auto& mismatch) {
           return mismatch.field == "canary";
         });
}

std::string line_of(const lks_bisect_report& report, const StateDifference& difference) {
  std::string line = "tick " + std::to_string(report.tick);
  if (report.in_inputs != 0) line += ", inputs of player " + std::to_string(report.slot);
  if (!difference.differs) return line;
  line += ", " + difference.to_line();
  if (report.difference_tick != report.tick + 1)
    line += " (state at " + std::to_string(report.difference_tick) + ")";
  return line;
}

lks_bisect_report bisect(lks_log& here, lks_log& there, const Game& game) {
  const replay::LogComparison logs = replay::compare_logs(*here.source, *there.source);
  if (!of_one_match(logs)) fail(Status::incompatible, "the logs are of different matches");
  if (logs.status != Status::ok && logs.status != Status::truncated) fail(logs.status, logs.what);
  lks_bisect_report report{};
  const auto tick = logs.first_difference();
  if (!tick) {
    write_text("no difference", report.line, sizeof report.line);
    return report;
  }
  report.found = 1;
  report.tick = *tick;
  if (logs.input && logs.input->tick == *tick) {
    report.in_inputs = 1;
    report.slot = logs.input->slot;
  }
  Side left(here, game, *tick), right(there, game, *tick);
  report.hash_here = left.recorded;
  report.hash_there = right.recorded;
  const StateDifference difference = difference_of(left, right, report.difference_tick);
  write_text(line_of(report, difference), report.line, sizeof report.line);
  return report;
}

lks_log& handle(lks_log* log) {
  return required(log, "log");
}

void next(lks_log& log) {
  log.read = false;
  if (!log.has_next) log.has_next = log.ticks->next();
  if (log.has_next) return;
  const replay::Damage& damage = log.ticks->reader().damage();
  if (damage.status == Status::ok) throw_status(LKS_NOT_FOUND, "the log has no more ticks");
  if (damage.status == Status::truncated) fail(Status::not_found, damage.what);
  fail(damage.status, damage.what);
}

}  // namespace

lks_status lks_log_open(const char* path, lks_log** out) {
  return call([&] {
    required(out, "out");
    auto source = replay::FileSource::open(&required(path, "path"));
    if (!source.ok()) {
      fail(source.status(), std::string(path) + ": " + std::string(to_string(source.status())));
    }
    auto log = std::make_unique<lks_log>();
    log->source = std::move(source).value();
    *out = open(std::move(log)).release();
  });
}

lks_status lks_log_open_bytes(const void* bytes, size_t count, lks_log** out) {
  return call([&] {
    required(out, "out");
    const ByteView given = bytes_of(bytes, count, "bytes");
    auto log = std::make_unique<lks_log>();
    log->bytes.assign(given.begin(), given.end());
    log->source = std::make_unique<replay::MemorySource>(log->bytes);
    *out = open(std::move(log)).release();
  });
}

void lks_log_close(lks_log* log) {
  delete log;
}

lks_status lks_log_get_info(lks_log* log, lks_log_info* info) {
  return call([&] {
    replay::Damage damage;
    auto read = replay::read_log_info(*handle(log).source, &damage);
    if (!read.ok()) fail(read.status(), damage.what);
    give(raw_of(read.value()), info, required(info, "info").size, "info");
  });
}

lks_status lks_log_player_name(lks_log* log, uint32_t slot, char* out, size_t capacity) {
  return call([&] {
    replay::Damage damage;
    auto read = replay::read_log_info(*handle(log).source, &damage);
    if (!read.ok()) fail(read.status(), damage.what);
    const std::vector<std::string>& names = read.value().player_names;
    if (slot >= names.size()) throw_invalid("slot", "there is no such slot");
    write_text(names[slot], array(out, capacity, "out"), capacity);
  });
}

lks_status lks_log_config(lks_log* log, void* out, size_t capacity, size_t* count) {
  return call([&] {
    give_bytes(handle(log).ticks->config(), out, capacity, required(count, "count"),
               "the configuration");
  });
}

lks_status lks_log_next(lks_log* log, uint64_t* tick, void* inputs, size_t bytes, uint32_t* origins,
                        uint64_t* hash) {
  return call([&] {
    lks_log& source = handle(log);
    required(tick, "tick");
    required(hash, "hash");
    auto* room = static_cast<std::byte*>(array(inputs, bytes, "inputs"));
    next(source);
    std::size_t needed = 0;
    for (const PlayerInput& input : source.ticks->inputs())
      needed += input.bytes.size();
    if (needed > bytes) {
      throw_status(LKS_BUFFER_TOO_SMALL, "the inputs have " + std::to_string(needed) + " bytes");
    }
    for (const PlayerInput& input : source.ticks->inputs()) {
      room = std::ranges::copy(input.bytes, room).out;
      if (origins != nullptr) *origins++ = static_cast<std::uint32_t>(input.origin);
    }
    *tick = source.ticks->tick();
    *hash = source.ticks->hash();
    source.has_next = false;
    source.read = true;
  });
}

lks_status lks_log_command(lks_log* log, size_t index, uint32_t* slot, void* out, size_t capacity,
                           size_t* count) {
  return call([&] {
    const lks_log& source = handle(log);
    required(slot, "slot");
    required(count, "count");
    if (source.has_next || !source.read) throw_status(LKS_NOT_FOUND, "no tick was read");
    const std::span<const PlayerCommand> commands = source.ticks->commands();
    if (index >= commands.size()) throw_status(LKS_NOT_FOUND, "the tick has no such command");
    *slot = commands[index].slot;
    give_bytes(commands[index].bytes, out, capacity, *count, "the command");
  });
}

lks_status lks_log_seek(lks_log* log, const lks_game* game, uint64_t tick, lks_simulation** out) {
  return call([&] {
    lks_log& source = handle(log);
    const auto& shared = required(game, "game").game;
    required(out, "out");
    replay::SeekResult found = replay::seek(*source.source, shared->make, tick);
    if (found.status != Status::ok) fail(found.status, found.what);
    const ByteView config = found.ticks->config();
    *out =
        make_handle(shared, {config.begin(), config.end()}, std::move(found.simulation)).release();
    source.ticks = std::move(found.ticks);
    source.read = false;
    source.has_next = false;
  });
}

lks_status lks_log_verify(lks_log* log, const lks_game* game, lks_log_report* report) {
  return call([&] {
    lks_log& source = handle(log);
    verify(*source.source, required(game, "game").game->make, required(report, "report"));
  });
}

lks_status lks_log_bisect(lks_log* here, lks_log* there, const lks_game* game,
                          lks_bisect_report* report) {
  return call([&] {
    lks_log& left = required(here, "here");
    lks_log& right = required(there, "there");
    const Game& known = *required(game, "game").game;
    check_size<lks_bisect_report>(required(report, "report").size, "report");
    give(bisect(left, right, known), report, report->size, "report");
  });
}
