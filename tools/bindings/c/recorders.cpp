// Recorders of logs.
#include "tools/bindings/c/game_handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

lks_recorder_def raw_def() {
  const replay::RecorderOptions options;
  lks_recorder_def raw{};
  raw.size = sizeof raw;
  raw.keyframe_interval_ticks = options.keyframe_interval_ticks;
  raw.compress = options.compress ? 1 : 0;
  return raw;
}

void must(Status status, const char* what) {
  if (status != Status::ok) {
    throw_status(static_cast<lks_status>(status),
                 std::string(what) + ": " + std::string(to_string(status)));
  }
}

replay::MatchMetadata metadata(const lks_recorder_def& def, const Match& match,
                               std::uint64_t start_tick) {
  replay::MatchMetadata data;
  data.match_id = def.match_id;
  data.seed = def.seed;
  data.start_tick = start_tick;
  data.build = text_in(def.build, "def.build");
  data.game = match.game->name;
  data.game_version = match.game->version;
  return data;
}

std::shared_ptr<Match> own_match(const lks_simulation* simulation) {
  const std::shared_ptr<Match>& match = required(simulation, "simulation").match;
  if (match == nullptr) throw_invalid("simulation", "is a client's: its server records the match");
  return match;
}

std::unique_ptr<lks_recorder> begin(const lks_recorder_def* def, std::shared_ptr<Match> match,
                                    std::unique_ptr<replay::Sink> sink) {
  const Simulation& simulation = *match->simulation;
  auto made = std::make_unique<lks_recorder>();
  made->log = LogWriter::begin(def, std::move(match), simulation, std::move(sink));
  return made;
}

}  // namespace

std::shared_ptr<LogWriter> lockstone::c::LogWriter::begin(const lks_recorder_def* from,
                                                          std::shared_ptr<Match> match,
                                                          const Simulation& simulation,
                                                          std::unique_ptr<replay::Sink> sink) {
  const lks_recorder_def def = take(from, raw_def(), "def");
  auto log = std::make_shared<LogWriter>();
  log->match = match;
  log->sink = std::move(sink);
  replay::RecorderOptions options;
  options.keyframe_interval_ticks = def.keyframe_interval_ticks;
  options.compress = flag(def.compress, "def.compress");
  options.keyframe_bytes_max = simulation.snapshot_bytes_max(SnapshotKind::canonical);
  log->recorder.emplace(*log->sink, options);
  must(log->recorder->begin(simulation.info(), match->config,
                            metadata(def, *match, simulation.tick())),
       "the log could not be begun");
  if (simulation.tick() > 0)
    must(log->recorder->keyframe(simulation), "the first state could not be written");
  return log;
}

lks_status lks_recorder_def_init(lks_recorder_def* def, size_t size) {
  return call([&] { give(raw_def(), def, size, "def"); });
}

lks_status lks_recorder_create(const lks_recorder_def* def, const lks_simulation* simulation,
                               const char* path, lks_recorder** out) {
  return call([&] {
    const lks_recorder_def raw = take(def, raw_def(), "def");
    std::shared_ptr<Match> match = own_match(simulation);
    required(out, "out");
    auto sink = replay::FileSink::create(&required(path, "path"), flag(raw.replace, "def.replace"));
    if (!sink.ok()) must(sink.status(), path);
    *out = begin(def, std::move(match), std::move(sink).value()).release();
  });
}

lks_status lks_recorder_create_in_memory(const lks_recorder_def* def,
                                         const lks_simulation* simulation, lks_recorder** out) {
  return call([&] {
    std::shared_ptr<Match> match = own_match(simulation);
    required(out, "out");
    auto sink = std::make_unique<replay::MemorySink>();
    const replay::MemorySink* memory = sink.get();
    auto made = begin(def, std::move(match), std::move(sink));
    made->log->memory = memory;
    *out = made.release();
  });
}

void lks_recorder_destroy(lks_recorder* recorder) {
  delete recorder;
}

lks_status lks_recorder_step(lks_recorder* recorder, const void* inputs, size_t bytes,
                             const uint32_t* origins) {
  return call([&] {
    LogWriter& log = *required(recorder, "recorder").log;
    if (log.match->simulation == nullptr)
      throw_status(LKS_READ_ONLY, "a client records its ticks itself");
    const Simulation& simulation = *log.match->simulation;
    const FlatInputs flat(simulation.info(), inputs, bytes, origins);
    must(log.recorder->record_step(simulation, flat.list()), "the tick was not recorded");
  });
}

lks_status lks_recorder_note(lks_recorder* recorder, const char* text) {
  return call([&] {
    replay::Recorder& target = *required(recorder, "recorder").log->recorder;
    must(target.event(target.next_tick(), replay::EventKind::note, replay::k_no_slot,
                      &required(text, "text")),
         "the note was not recorded");
  });
}

lks_status lks_recorder_finish(lks_recorder* recorder, const char* reason) {
  return call([&] {
    replay::Recorder& target = *required(recorder, "recorder").log->recorder;
    must(target.finish(&required(reason, "reason")), "the log's end was not written");
  });
}

lks_status lks_recorder_bytes(const lks_recorder* recorder, void* out, size_t capacity,
                              size_t* count) {
  return call([&] {
    const LogWriter& log = *required(recorder, "recorder").log;
    if (log.memory == nullptr) throw_status(LKS_NOT_FOUND, "the log is written to a file");
    give_bytes(log.memory->bytes(), out, capacity, required(count, "count"), "the log");
  });
}
