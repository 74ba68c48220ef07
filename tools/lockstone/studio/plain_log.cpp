#include "tools/lockstone/studio/plain_log.h"

#include <algorithm>
#include <memory>

#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/replay/sink.h>

namespace lockstone::tool {
namespace {

// The longest keyframe, for the recorder's room.
std::size_t longest_keyframe(replay::Source& source) {
  replay::LogReader reader(source);
  std::size_t most = 0;
  if (reader.open() != Status::ok) return most;
  for (replay::LogItem item = reader.next(); !replay::is_last(item); item = reader.next())
    if (item == replay::LogItem::keyframe) most = std::max(most, reader.snapshot().size());
  return most;
}

Status copy_ticks(const replay::LogReader& reader, replay::Recorder& recorder) {
  for (std::size_t i = 0; i < reader.hashes().size(); ++i) {
    Status status = recorder.record_commands(reader.tick_commands(i));
    if (status != Status::ok) return status;
    status = recorder.record_tick(reader.chunk().first_tick + i, reader.tick_inputs(i),
                                  reader.hashes()[i]);
    if (status != Status::ok) return status;
  }
  return Status::ok;
}

Status copy_events(const replay::LogReader& reader, replay::Recorder& recorder) {
  for (const replay::LogEvent& event : reader.events()) {
    const Status status = recorder.event(event.tick, event.kind, event.slot, event.text);
    if (status != Status::ok) return status;
  }
  return Status::ok;
}

Status copy_item(const replay::LogReader& reader, replay::LogItem item,
                 replay::Recorder& recorder) {
  switch (item) {
    case replay::LogItem::scene:
      return recorder.begin(reader.header().info, reader.config(), reader.header().match);
    case replay::LogItem::hashes:
      return copy_ticks(reader, recorder);
    case replay::LogItem::keyframe:
      return recorder.keyframe(reader.chunk().first_tick, reader.keyframe_hash(),
                               reader.snapshot());
    case replay::LogItem::events:
      return copy_events(reader, recorder);
    case replay::LogItem::end:
      return recorder.finish(reader.end().reason, reader.end().kind);
    default:
      return Status::ok;
  }
}

}  // namespace

std::optional<std::string> plain_log(replay::Source& source) {
  replay::MemorySink sink;
  {
    replay::Recorder recorder(sink,
                              {.keyframe_bytes_max = longest_keyframe(source), .compress = false});
    replay::LogReader reader(source);
    if (reader.open() != Status::ok) return std::nullopt;
    for (replay::LogItem item = reader.next(); !replay::is_last(item); item = reader.next())
      if (copy_item(reader, item, recorder) != Status::ok) return std::nullopt;
  }
  if (sink.bytes().empty()) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(sink.bytes().data()), sink.bytes().size());
}

}  // namespace lockstone::tool
