#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <lockstone/assert.h>
#include <lockstone/replay/log_reader.h>

#include "replay/chunk_reader.h"
#include "replay/input_codec.h"
#include "replay/record_codec.h"

namespace lockstone::replay {

std::string_view to_string(LogItem item) {
  constexpr std::array<std::string_view, 10> k_names{"scene",  "inputs", "hashes",  "keyframe",
                                                     "events", "end",    "skipped", "finished",
                                                     "torn",   "damaged"};
  const auto index = static_cast<std::size_t>(item);
  return index < k_names.size() ? k_names[index] : "unknown";
}

struct LogReader::Parts {
  explicit Parts(Source& source) : chunks(source) {}

  ChunkReader chunks;
  LogItem item = LogItem::skipped;  // the last answer
  InputBlock inputs;
  std::vector<std::uint64_t> hashes;
  std::vector<LogEvent> events;
  LogEnd end;
  LogEnd seen;  // totals so far, which the END must repeat
  Transcript transcript;
  std::optional<std::uint64_t> last_keyframe;  // its tick
  std::uint64_t next_tick = 0;
  std::uint64_t keyframe_hash = 0;
  bool opened = false;
  bool has_scene = false;
  bool awaits_hashes = false;  // the last chunk was INPUT
  bool complete = false;
  bool signed_end = false;  // a SIGNATURE stands behind the END
  bool arrives = false;     // the next chunk is the keyframe that was jumped to
  bool jumped = false;      // `seen` does not count earlier items

  LogItem reject(Status status, const char* what) {
    chunks.reject_chunk(status, what);
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
  return parts_->transcript.value();
}
void LogReader::bound_snapshots(std::size_t bytes) {
  parts_->chunks.bound_snapshots(bytes);
}
bool LogReader::complete() const {
  return parts_->complete;
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

Status LogReader::open() {
  LKS_ASSERT(!parts_->opened);
  if (parts_->chunks.open() != Walk::good) {
    parts_->item = LogItem::damaged;
    return damage().status;
  }
  parts_->opened = true;
  parts_->next_tick = header().match.start_tick;
  return Status::ok;
}

Status LogReader::jump(const KeyframePlace& place) {
  LKS_ASSERT(parts_->has_scene && !is_last(parts_->item));
  const Status status = parts_->chunks.jump(place.offset);
  if (status != Status::ok) return status;
  parts_->seen = {};
  parts_->transcript = {};
  parts_->last_keyframe.reset();
  parts_->next_tick = place.tick;
  parts_->awaits_hashes = false;
  parts_->arrives = parts_->jumped = true;
  return Status::ok;
}

LogItem LogReader::next() {
  LKS_ASSERT(parts_->opened || parts_->item == LogItem::damaged);
  if (!is_last(parts_->item)) parts_->item = read_next();
  return parts_->item;
}

LogItem LogReader::read_next() {
  if (parts_->complete) return read_behind_end();
  ChunkReader& chunks = parts_->chunks;
  const Walk walk = chunks.next_frame();
  if (walk == Walk::finished) return LogItem::finished;
  if (walk == Walk::torn) return LogItem::torn;
  if (walk != Walk::good || chunks.read_payload() != Walk::good) return LogItem::damaged;
  if (!is_known(chunk().type)) {
    if ((chunk().flags & k_flag_may_skip) != 0) return LogItem::skipped;
    return parts_->reject(Status::unsupported_version, "of a type that this build must not skip");
  }
  if (!check_frame() || !check_order()) return LogItem::damaged;
  return chunks.unpack() == Walk::good ? read_known() : LogItem::damaged;
}

// One signature over all before it, and nothing else.
LogItem LogReader::read_behind_end() {
  ChunkReader& chunks = parts_->chunks;
  const Walk walk = chunks.next_frame();
  if (walk == Walk::finished) return LogItem::finished;
  const bool is_signature = walk == Walk::good && chunk().type == ChunkType::signature &&
                            !std::exchange(parts_->signed_end, true);
  if (!is_signature) {
    chunks.reject_rest();
    return LogItem::damaged;
  }
  return chunks.read_payload() == Walk::good ? LogItem::skipped : LogItem::damaged;
}

bool LogReader::check_frame() {
  if (chunk().version != k_chunk_version || chunk().codec > Codec::zstd) {
    (void)parts_->reject(Status::unsupported_version, "unknown chunk version or codec");
    return false;
  }
  const bool has_ticks = chunk().type == ChunkType::input || chunk().type == ChunkType::hash;
  const std::size_t second = max_chunk_ticks(header().info);
  const bool in_range = has_ticks ? chunk().count >= 1 && chunk().count <= second
                                  : chunk().count == 0 || chunk().type == ChunkType::event;
  if (!in_range) (void)parts_->reject(Status::malformed, "count out of range");
  return in_range;
}

// A scene first; then inputs and their hashes in turn, and at most one keyframe between them.
bool LogReader::check_order() {
  const ChunkType type = chunk().type;
  const auto fail = [&](const char* what) {
    (void)parts_->reject(Status::malformed, what);
    return false;
  };
  if (parts_->has_scene == (type == ChunkType::scene))
    return fail("the scene comes first, and once");
  if (parts_->arrives && type != ChunkType::keyframe) return fail("not the keyframe looked for");
  if (parts_->awaits_hashes != (type == ChunkType::hash)) {
    return fail("each INPUT chunk is followed by its HASH chunk");
  }
  if (type == ChunkType::keyframe && parts_->last_keyframe == chunk().first_tick) {
    return fail("a second keyframe of one tick");
  }
  return check_place();
}

// Tick after tick.
bool LogReader::check_place() {
  const std::uint64_t behind = chunk().type == ChunkType::hash ? parts_->inputs.ticks() : 0;
  if (chunk().first_tick == parts_->next_tick - behind) return true;
  (void)parts_->reject(Status::malformed, "not at the log's next tick");
  return false;
}

LogItem LogReader::read_known() {
  switch (chunk().type) {
    case ChunkType::scene:
      return read_scene();
    case ChunkType::input:
      return read_inputs();
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

LogItem LogReader::read_scene() {
  parts_->has_scene = true;
  return LogItem::scene;
}

LogItem LogReader::read_inputs() {
  if (header().match.start_tick > 0 && parts_->seen.keyframes == 0) {
    return parts_->reject(Status::malformed, "no keyframe at the start tick");
  }
  const SimulationInfo& info = header().info;
  const DecodeFault fault = parts_->inputs.decode(parts_->chunks.payload(), chunk().count,
                                                  info.player_count, info.input_bytes);
  if (!fault.ok()) return parts_->reject(fault);
  parts_->awaits_hashes = true;
  parts_->next_tick += chunk().count;
  return LogItem::inputs;
}

LogItem LogReader::read_hashes() {
  const ByteView payload = parts_->chunks.payload();
  const std::size_t count = parts_->inputs.ticks();
  if (chunk().count != count || payload.size() != count * sizeof(std::uint64_t)) {
    return parts_->reject(Status::malformed, "not one hash for each tick of its INPUT chunk");
  }
  ByteReader reader(payload);
  parts_->hashes.resize(count);
  for (std::uint64_t& hash : parts_->hashes)
    hash = reader.get<std::uint64_t>();
  for (std::size_t i = 0; i < count; ++i)
    parts_->transcript.add(chunk().first_tick + i, parts_->inputs.tick(i));
  parts_->awaits_hashes = false;
  parts_->seen.ticks += count;
  parts_->seen.final_hash = parts_->hashes.back();
  return LogItem::hashes;
}

LogItem LogReader::read_keyframe() {
  const ByteView payload = parts_->chunks.payload();
  if (payload.size() <= sizeof(std::uint64_t)) {
    return parts_->reject(Status::malformed, "no snapshot in it");
  }
  parts_->keyframe_hash = ByteReader(payload).get<std::uint64_t>();
  if (parts_->seen.ticks > 0 && parts_->keyframe_hash != parts_->seen.final_hash) {
    return parts_->reject(Status::malformed, "its hash is not that of the tick before");
  }
  const bool has_tick_before = chunk().first_tick > header().match.start_tick;
  if (parts_->arrives && has_tick_before) parts_->seen.final_hash = parts_->keyframe_hash;
  parts_->arrives = false;
  parts_->last_keyframe = chunk().first_tick;
  ++parts_->seen.keyframes;
  return LogItem::keyframe;
}

LogItem LogReader::read_events() {
  const DecodeFault fault = decode_events(parts_->chunks.payload(), chunk().count,
                                          header().info.player_count, parts_->events);
  if (!fault.ok()) return parts_->reject(fault);
  parts_->seen.events += parts_->events.size();
  return LogItem::events;
}

LogItem LogReader::read_end() {
  const DecodeFault fault = decode_end(parts_->chunks.payload(), parts_->end);
  if (!fault.ok()) return parts_->reject(fault);
  if (!check_end(parts_->end)) {
    return parts_->reject(Status::malformed, "its totals are not those of the log");
  }
  if (!parts_->jumped && parts_->end.transcript != parts_->transcript.value()) {
    return parts_->reject(Status::malformed, "its transcript is not that of the log's inputs");
  }
  parts_->complete = true;
  return LogItem::end;
}

bool LogReader::check_end(const LogEnd& end) const {
  const LogEnd& seen = parts_->seen;
  const bool ends_here = end.final_tick == parts_->next_tick && end.final_hash == seen.final_hash;
  if (parts_->jumped) return ends_here;
  return ends_here && end.ticks == seen.ticks && end.events == seen.events &&
         end.keyframes == seen.keyframes;
}

}  // namespace lockstone::replay
