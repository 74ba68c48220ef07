#include <algorithm>
#include <array>

#include <lockstone/assert.h>
#include <lockstone/replay/log_reader.h>

#include "replay/chunks/chunk_reader.h"
#include "replay/chunks/log_order.h"
#include "replay/codec/command_codec.h"
#include "replay/codec/input_codec.h"
#include "replay/codec/record_codec.h"

namespace lockstone::replay {

std::string_view to_string(LogItem item) {
  constexpr std::array<std::string_view, 11> k_names{"scene",    "inputs", "hashes", "keyframe",
                                                     "commands", "events", "end",    "skipped",
                                                     "finished", "torn",   "damaged"};
  const auto index = static_cast<std::size_t>(item);
  return index < k_names.size() ? k_names[index] : "unknown";
}

/// Reads one chunk after another, checks it, and decodes its content.
struct LogReader::Parts {
  explicit Parts(Source& source) : chunks(source) {}

  [[nodiscard]] LogItem read_next();

  ChunkReader chunks;
  LogOrder order;
  LogItem item = LogItem::skipped;  // the last answer
  bool opened = false;

  // The content of the last chunk of each kind.
  InputBlock inputs;
  CommandBlock commands;
  std::uint64_t first_tick = 0;  // of the inputs
  std::vector<std::uint64_t> hashes;
  std::vector<LogEvent> events;
  LogEnd end;
  std::uint64_t keyframe_hash = 0;

 private:
  [[nodiscard]] const ChunkHeader& chunk() const { return chunks.chunk(); }
  [[nodiscard]] LogItem read_behind_end();
  [[nodiscard]] LogItem read_known();
  [[nodiscard]] bool check_frame();
  [[nodiscard]] LogItem read_inputs();
  [[nodiscard]] LogItem read_commands();
  [[nodiscard]] LogItem read_hashes();
  [[nodiscard]] LogItem read_keyframe();
  [[nodiscard]] LogItem read_events();
  [[nodiscard]] LogItem read_end();

  LogItem reject(Status status, const char* reason) {
    chunks.reject_chunk(status, reason);
    return LogItem::damaged;
  }
  LogItem reject(const DecodeFault& fault) {
    chunks.reject_payload(fault);
    return LogItem::damaged;
  }
};

LogReader::LogReader(Source& source) : parts_(std::make_unique<Parts>(source)) {}
LogReader::~LogReader() = default;

const LogHeader& LogReader::header() const {
  return parts_->chunks.log();
}
const ChunkHeader& LogReader::chunk() const {
  return parts_->chunks.chunk();
}
std::uint64_t LogReader::chunk_offset() const {
  return parts_->chunks.chunk_offset();
}
ByteView LogReader::config() const {
  return parts_->chunks.payload();
}
std::span<const std::uint64_t> LogReader::hashes() const {
  return parts_->hashes;
}
std::uint64_t LogReader::keyframe_hash() const {
  return parts_->keyframe_hash;
}
std::span<const LogEvent> LogReader::events() const {
  return parts_->events;
}
const LogEnd& LogReader::end() const {
  return parts_->end;
}
TranscriptHash LogReader::transcript() const {
  return parts_->order.transcript();
}
void LogReader::bound_snapshots(std::size_t bytes) {
  parts_->chunks.bound_snapshots(bytes);
}
bool LogReader::complete() const {
  return parts_->order.complete();
}
const Damage& LogReader::damage() const {
  return parts_->chunks.damage();
}

ByteView LogReader::snapshot() const {
  LKS_ASSERT(parts_->item == LogItem::keyframe);
  return parts_->chunks.payload().subspan(sizeof(std::uint64_t));
}

std::span<const PlayerInput> LogReader::tick_inputs(std::size_t index) const {
  LKS_ASSERT(index < parts_->inputs.ticks());
  return parts_->inputs.tick(index);
}

std::span<const PlayerCommand> LogReader::tick_commands(std::size_t index) const {
  LKS_ASSERT(index < parts_->inputs.ticks());
  return parts_->commands.of(parts_->first_tick + index);
}

Status LogReader::open() {
  LKS_ASSERT(!parts_->opened);
  if (parts_->chunks.open() != Walk::good) {
    parts_->item = LogItem::damaged;
    return damage().status;
  }
  parts_->opened = true;
  parts_->order.begin(header().match.start_tick);
  return Status::ok;
}

Status LogReader::jump(const KeyframePlace& place) {
  LKS_ASSERT(parts_->order.has_scene() && !is_last(parts_->item));
  const Status status = parts_->chunks.jump(place.offset);
  if (status == Status::ok) parts_->order.jump(place.tick);
  return status;
}

LogItem LogReader::next() {
  LKS_ASSERT(parts_->opened || parts_->item == LogItem::damaged);
  if (!is_last(parts_->item)) parts_->item = parts_->read_next();
  return parts_->item;
}

LogItem LogReader::Parts::read_next() {
  if (order.complete()) return read_behind_end();
  const Walk walk = chunks.next_frame();
  if (walk == Walk::finished) return LogItem::finished;
  if (walk == Walk::torn) return LogItem::torn;
  if (walk != Walk::good || chunks.read_payload() != Walk::good) return LogItem::damaged;
  if (!is_known(chunk().type)) {
    if ((chunk().flags & k_flag_may_skip) != 0) return LogItem::skipped;
    return reject(Status::unsupported_version, "of a type that this build must not skip");
  }
  if (!check_frame()) return LogItem::damaged;
  if (const char* fault = order.check(chunk())) return reject(Status::malformed, fault);
  return chunks.unpack() == Walk::good ? read_known() : LogItem::damaged;
}

// One signature over all before it, and nothing else.
LogItem LogReader::Parts::read_behind_end() {
  const Walk walk = chunks.next_frame();
  if (walk == Walk::finished) return LogItem::finished;
  const bool is_signature =
      walk == Walk::good && chunk().type == ChunkType::signature && order.take_signature();
  if (!is_signature) {
    chunks.reject_rest();
    return LogItem::damaged;
  }
  return chunks.read_payload() == Walk::good ? LogItem::skipped : LogItem::damaged;
}

bool LogReader::Parts::check_frame() {
  if (chunk().version != k_chunk_version || chunk().codec > Codec::zstd) {
    (void)reject(Status::unsupported_version, "unknown chunk version or codec");
    return false;
  }
  const bool has_ticks = chunk().type == ChunkType::input || chunk().type == ChunkType::hash;
  const std::size_t second = max_chunk_ticks(chunks.log().info);
  const bool in_range = has_ticks ? chunk().count >= 1 && chunk().count <= second
                                  : chunk().count == 0 || chunk().type == ChunkType::event ||
                                        chunk().type == ChunkType::command;
  if (!in_range) (void)reject(Status::malformed, "count out of range");
  return in_range;
}

LogItem LogReader::Parts::read_known() {
  switch (chunk().type) {
    case ChunkType::scene:
      order.note_scene();
      return LogItem::scene;
    case ChunkType::input:
      return read_inputs();
    case ChunkType::command:
      return read_commands();
    case ChunkType::hash:
      return read_hashes();
    case ChunkType::keyframe:
      return read_keyframe();
    case ChunkType::event:
      return read_events();
    default:
      return read_end();
  }
}

LogItem LogReader::Parts::read_inputs() {
  if (const char* fault = order.check_start()) return reject(Status::malformed, fault);
  const SimulationInfo& info = chunks.log().info;
  const DecodeFault fault =
      inputs.decode(chunks.payload(), chunk().count, info.player_count, info.input_bytes);
  if (!fault.ok()) return reject(fault);
  if (!order.awaits_inputs()) commands.clear();
  first_tick = chunk().first_tick;
  if (commands.end_tick() > first_tick + chunk().count) {
    return reject(Status::malformed, "the COMMAND chunk before it is of later ticks too");
  }
  order.note_inputs(chunk().count);
  return LogItem::inputs;
}

LogItem LogReader::Parts::read_commands() {
  if (const char* fault = order.check_start()) return reject(Status::malformed, fault);
  const DecodeFault fault = commands.decode(chunks.payload(), chunk().count, chunk().first_tick,
                                            chunks.log().info.player_count);
  if (!fault.ok()) return reject(fault);
  order.note_commands();
  return LogItem::commands;
}

LogItem LogReader::Parts::read_hashes() {
  const ByteView payload = chunks.payload();
  const std::size_t count = inputs.ticks();
  if (chunk().count != count || payload.size() != count * sizeof(std::uint64_t)) {
    return reject(Status::malformed, "not one hash for each tick of its INPUT chunk");
  }
  ByteReader reader(payload);
  hashes.resize(count);
  for (std::uint64_t& hash : hashes)
    hash = reader.get<std::uint64_t>();
  for (std::size_t i = 0; i < count; ++i)
    order.add_to_transcript(first_tick + i, inputs.tick(i), commands.of(first_tick + i));
  order.note_hashes(hashes.back());
  return LogItem::hashes;
}

LogItem LogReader::Parts::read_keyframe() {
  const ByteView payload = chunks.payload();
  if (payload.size() <= sizeof(std::uint64_t)) {
    return reject(Status::malformed, "no snapshot in it");
  }
  keyframe_hash = ByteReader(payload).get<std::uint64_t>();
  const char* fault = order.check_keyframe(keyframe_hash);
  if (fault != nullptr) return reject(Status::malformed, fault);
  order.note_keyframe(chunk().first_tick, keyframe_hash);
  return LogItem::keyframe;
}

LogItem LogReader::Parts::read_events() {
  const DecodeFault fault =
      decode_events(chunks.payload(), chunk().count, chunks.log().info.player_count, events);
  if (!fault.ok()) return reject(fault);
  order.note_events(events.size());
  return LogItem::events;
}

LogItem LogReader::Parts::read_end() {
  const DecodeFault fault = decode_end(chunks.payload(), end);
  if (!fault.ok()) return reject(fault);
  if (const char* wrong = order.check_end(end)) return reject(Status::malformed, wrong);
  order.note_end();
  return LogItem::end;
}

}  // namespace lockstone::replay
