#include <algorithm>

#include <lockstone/replay/log_info.h>
#include <lockstone/replay/log_reader.h>

namespace lockstone::replay {
namespace {

void count_chunk(const ChunkHeader& chunk, std::vector<ChunkTypeTotals>& types) {
  const auto place = std::lower_bound(
      types.begin(), types.end(), chunk.type,
      [](const ChunkTypeTotals& totals, ChunkType type) { return totals.type < type; });
  const bool known = place != types.end() && place->type == chunk.type;
  ChunkTypeTotals& totals = known ? *place : *types.insert(place, {.type = chunk.type});
  ++totals.chunks;
  totals.raw_bytes += chunk.raw_bytes;
  totals.stored_bytes += k_chunk_header_bytes + chunk.stored_bytes;
}

void count_inputs(const LogReader& reader, LogInfo& info) {
  for (std::size_t i = 0; i < reader.chunk().count; ++i) {
    for (const PlayerInput& input : reader.tick_inputs(i)) {
      ++info.inputs_by_origin[static_cast<std::size_t>(input.origin)];
    }
  }
}

void count_commands(const LogReader& reader, LogInfo& info) {
  for (std::size_t i = 0; i < reader.chunk().count; ++i) {
    for (const PlayerCommand& command : reader.tick_commands(i)) {
      ++info.commands;
      info.command_bytes += command.bytes.size();
    }
  }
}

void list_events(const LogReader& reader, LogInfo& info) {
  info.event_count += reader.events().size();
  const std::size_t room = k_max_listed_events - info.events.size();
  const auto listed = reader.events().first(std::min(room, reader.events().size()));
  info.events.insert(info.events.end(), listed.begin(), listed.end());
}

void note_names(const LogReader& reader, LogInfo& info) {
  for (const LogEvent& event : reader.events()) {
    const bool names = event.kind == EventKind::name && event.slot < info.player_names.size();
    if (names) info.player_names[event.slot] = event.text;
  }
}

void take(LogItem item, const LogReader& reader, LogInfo& info) {
  count_chunk(reader.chunk(), info.chunk_types);
  switch (item) {
    case LogItem::scene:
      info.config_bytes = reader.config().size();
      return;
    case LogItem::inputs:
      return count_inputs(reader, info);
    case LogItem::hashes:
      count_commands(reader, info);
      info.ticks += reader.hashes().size();
      info.last_hash = reader.hashes().back();
      return;
    case LogItem::keyframe:
      info.keyframe_ticks.push_back(reader.chunk().first_tick);
      return;
    case LogItem::events:
      note_names(reader, info);
      return list_events(reader, info);
    case LogItem::end:
      info.end_reason = reader.end().reason;
      return;
    default:
      return;
  }
}

}  // namespace

Result<LogInfo> read_log_info(Source& source, Damage* damage) {
  LogReader reader(source);
  const Status status = reader.open();
  if (damage != nullptr) *damage = reader.damage();
  if (status != Status::ok) return status;
  LogInfo info;
  info.header = reader.header();
  info.player_names.resize(info.header.info.player_count);
  info.file_bytes = source.size();
  LogItem item = reader.next();
  for (; !is_last(item); item = reader.next())
    take(item, reader, info);
  const std::uint64_t rate = info.header.info.tick_rate;
  info.duration_milliseconds = info.ticks / rate * 1000 + info.ticks % rate * 1000 / rate;
  info.complete = reader.complete();
  info.torn_tail = item == LogItem::torn;
  if (item != LogItem::finished) info.damage = reader.damage();
  return info;
}

}  // namespace lockstone::replay
