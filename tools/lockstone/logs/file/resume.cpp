#include "tools/lockstone/logs/file/resume.h"

#include <fmt/format.h>

#include <lockstone/replay/seek.h>
#include <lockstone/replay/source.h>

#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

std::nullopt_t refuse(const std::string& path, std::string_view why) {
  complain(fmt::format("cannot resume {}: {}", path, why));
  return std::nullopt;
}

net::SlotMask playing(std::span<const PlayerInput> inputs) {
  net::SlotMask mask = 0;
  for (std::size_t slot = 0; slot < inputs.size(); ++slot)
    if (inputs[slot].origin != InputOrigin::absent) mask |= net::slot_bit(slot);
  return mask;
}

// Walks to the last whole tick; returns the number of ticks.
std::optional<std::uint64_t> read_all(const std::string& path, replay::LogReader& reader,
                                      ResumedMatch& match) {
  if (const Status status = reader.open(); status != Status::ok) {
    return refuse(path, to_string(status));
  }
  match.header = reader.header();
  if (match.header.match.start_tick != 0) return refuse(path, "it is a part of a log");
  std::uint64_t ticks = 0;
  replay::LogItem item = reader.next();
  for (; !is_last(item); item = reader.next()) {
    if (item == replay::LogItem::scene) {
      match.match.config.assign(reader.config().begin(), reader.config().end());
    }
    if (item != replay::LogItem::hashes) continue;
    ticks = reader.chunk().first_tick + reader.hashes().size();
    match.playing_mask = playing(reader.tick_inputs(reader.hashes().size() - 1));
  }
  if (reader.complete()) return refuse(path, "its match is over");
  if (item == replay::LogItem::damaged) return refuse(path, "it is damaged, repair it first");
  if (ticks == 0) return refuse(path, "it has no ticks");
  return ticks;
}

Status copy_item(replay::LogItem item, const replay::LogReader& reader,
                 replay::Recorder& recorder) {
  Status status = Status::ok;
  const std::uint64_t first = item == replay::LogItem::skipped ? 0 : reader.chunk().first_tick;
  if (item == replay::LogItem::hashes) {
    for (std::size_t i = 0; i < reader.hashes().size() && status == Status::ok; ++i) {
      status = recorder.record_commands(reader.tick_commands(i));
      if (status != Status::ok) return status;
      status = recorder.record_tick(first + i, reader.tick_inputs(i), reader.hashes()[i]);
    }
  }
  if (item == replay::LogItem::keyframe) {
    status = recorder.keyframe(first, reader.keyframe_hash(), reader.snapshot());
  }
  if (item != replay::LogItem::events) return status;
  for (const replay::LogEvent& event : reader.events()) {
    if (status == Status::ok)
      status = recorder.event(event.tick, event.kind, event.slot, event.text);
  }
  return status;
}

}  // namespace

std::optional<ResumedMatch> load_killed_match(const Games& games, const std::string& path) {
  const GameLog log = open_game_log(games, path);
  if (log.source == nullptr) return std::nullopt;
  ResumedMatch match;
  match.match.game = log.game;
  replay::LogReader reader(*log.source);
  const std::optional<std::uint64_t> ticks = read_all(path, reader, match);
  if (!ticks) return std::nullopt;
  replay::SeekResult found = replay::seek(*log.source, log.game->make, *ticks);
  if (found.status != Status::ok) return refuse(path, found.what);
  if (found.diverged || !found.same_canary) return refuse(path, "its ticks give other states here");
  match.match.simulation = std::move(found.simulation);
  return match;
}

Status copy_log(const std::string& path, replay::Recorder& recorder) {
  const auto source = replay::FileSource::open(path);
  if (!source) return source.status();
  replay::LogReader reader(*source.value());
  Status status = reader.open();
  while (status == Status::ok) {
    const replay::LogItem item = reader.next();
    if (is_last(item)) return Status::ok;
    status = copy_item(item, reader, recorder);
  }
  return status;
}

}  // namespace lockstone::tool
