#include "tools/lockstone/match/match_log.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/file/resume.h"
#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/support/console.h"
#include "tools/tool/games.h"

namespace lockstone::tool {

Status MatchLog::open(const MatchOptions& options, const GameDef& game,
                      const Simulation& simulation, ByteView config) {
  if (options.record.empty() && options.bundle.empty()) return Status::ok;
  if (options.record.empty()) {
    auto memory = std::make_unique<replay::MemorySink>();
    memory_ = memory.get();
    sink_ = std::move(memory);
  } else {
    const bool resumes = !options.resume.empty();
    auto sink = replay::FileSink::create(options.record + (resumes ? k_unfinished : ""),
                                         options.force || resumes);
    if (!sink) return sink.status();
    sink_ = std::move(sink).value();
  }
  replay::RecorderOptions recorder_options;
  recorder_options.keyframe_bytes_max = simulation.snapshot_bytes_max(SnapshotKind::canonical);
  recorder_options.signing_key = options.signing_key;
  background_.emplace(*sink_);
  recorder_.emplace(*background_, recorder_options);
  replay::MatchMetadata match{.match_id = random_match_id(), .seed = options.start.seed};
  name_game(game, match);
  const Status begun = recorder_->begin(simulation.info(), config, match);
  return note(begun == Status::ok && !options.resume.empty() ? take_over(options) : begun);
}

void MatchLog::commands(std::span<const PlayerCommand> commands) {
  if (active()) static_cast<void>(note(recorder_->record_commands(commands)));
}

void MatchLog::record(const Simulation& simulation, std::uint64_t tick,
                      std::span<const PlayerInput> inputs, std::uint64_t hash) {
  if (!active()) return;
  if (note(recorder_->record_tick(tick, inputs, hash)) != Status::ok) return;
  if (recorder_->keyframe_due()) static_cast<void>(note(recorder_->keyframe(simulation)));
}

void MatchLog::event(replay::EventKind kind, std::uint8_t slot, std::string_view text) {
  if (!active()) return;
  static_cast<void>(note(recorder_->event(recorder_->next_tick(), kind, slot, text)));
}

Status MatchLog::finish(std::string_view reason) {
  if (active()) static_cast<void>(note(recorder_->finish(reason)));
  if (background_) static_cast<void>(note(background_->close()));
  return status_;
}

std::vector<std::byte> MatchLog::bytes(const std::string& record) const {
  if (memory_ != nullptr) return memory_->bytes();
  const std::string text = read_file(record).value_or("");
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

// The old log stays as it is until the new one holds all of it, and then gives way at once.
Status MatchLog::take_over(const MatchOptions& options) {
  Status status = copy_log(options.resume, *recorder_);
  if (status == Status::ok) status = recorder_->flush();
  std::error_code error;
  if (status == Status::ok && memory_ == nullptr) {
    std::filesystem::rename(options.record + k_unfinished, options.record, error);
  }
  return error ? Status::io_error : status;
}

Status MatchLog::note(Status status) {
  if (status != Status::ok && status_ == Status::ok) {
    status_ = status;
    complain(fmt::format("the log is given up: {}", to_string(status)));
  }
  return status;
}

}  // namespace lockstone::tool
