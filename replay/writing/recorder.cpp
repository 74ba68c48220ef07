#include <algorithm>
#include <limits>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/replay/recorder.h>

#include "replay/chunks/chunk_writer.h"
#include "replay/codec/compression.h"
#include "replay/codec/header_codec.h"
#include "replay/codec/index_codec.h"
#include "replay/codec/input_codec.h"
#include "replay/codec/record_codec.h"
#include "replay/writing/command_chunk.h"

namespace lockstone::replay {
namespace {

constexpr std::size_t k_event_buffer_bytes = 8192;

// A keyframe's payload: the hash of the state, then the snapshot.
constexpr std::size_t k_keyframe_prefix_bytes = k_chunk_header_bytes + sizeof(std::uint64_t);

bool in_range(const SimulationInfo& info) {
  return info.tick_rate > 0 && info.player_count > 0 && info.player_count <= k_max_players &&
         info.input_bytes > 0 && info.input_bytes <= k_max_input_bytes;
}

bool fits(const SimulationInfo& info, std::span<const PlayerInput> inputs) {
  return inputs.size() == info.player_count &&
         std::all_of(inputs.begin(), inputs.end(), [&info](const PlayerInput& input) {
           return input.bytes.size() == info.input_bytes && input.origin <= InputOrigin::absent;
         });
}

std::uint32_t chunk_ticks(const RecorderOptions& options, const SimulationInfo& info) {
  const std::uint32_t second =
      std::min<std::uint32_t>(info.tick_rate, std::uint32_t{k_max_chunk_ticks});
  return options.chunk_ticks == 0 ? second : std::min(options.chunk_ticks, second);
}

std::uint32_t keyframe_interval(const RecorderOptions& options, std::uint64_t age) {
  const std::uint32_t early = options.early_keyframe_interval_ticks;
  if (age > k_early_ticks || early == 0) return options.keyframe_interval_ticks;
  return std::min(options.keyframe_interval_ticks, early);
}

}  // namespace

// Everything that is written is composed here. `group` holds INPUT, HASH and EVENT chunks one after
// the other, so that one append carries them; the inputs are coded straight into their place.
struct Recorder::Buffers {
  explicit Buffers(Sink& sink) : writer(sink) {}

  ChunkWriter writer;
  std::optional<Compressor> compressor;
  std::optional<IndexBuilder> index;
  std::vector<std::byte> group;
  std::vector<std::uint64_t> hashes;  // reserved for a chunk's ticks
  std::vector<std::byte> events;
  std::vector<std::byte> keyframe;
  CommandChunk commands;
  std::size_t event_bytes = 0;
  std::uint32_t event_count = 0;
  InputEncoder inputs;
  Transcript transcript;
};

Recorder::Recorder(Sink& sink, const RecorderOptions& options) : sink_(sink), options_(options) {}

Recorder::~Recorder() {
  if (state_ == State::recording) (void)flush();
}

Status Recorder::begin(const SimulationInfo& info, ByteView config, const MatchMetadata& match) {
  if (state_ != State::idle || !in_range(info) || match.start_tick > k_max_start_tick ||
      config.size() > k_max_scene_bytes || options_.keyframe_bytes_max > k_max_keyframe_bytes) {
    return Status::invalid_argument;
  }
  if (options_.signing_key && !signing_available()) return Status::invalid_argument;
  info_ = info;
  options_.chunk_ticks = chunk_ticks(options_, info);
  start_tick_ = next_tick_ = last_keyframe_tick_ = match.start_tick;
  allocate(config);
  state_ = State::recording;
  const Status status = write_beginning({info, match}, config);
  start_chunk();
  return status;
}

void Recorder::allocate(ByteView config) {
  buffers_ = std::make_unique<Buffers>(sink_);
  if (options_.signing_key) buffers_->writer.set_key(*options_.signing_key);
  if (options_.compress) {
    buffers_->compressor.emplace(
        std::max(config.size(), sizeof(std::uint64_t) + options_.keyframe_bytes_max));
  }
  if (options_.index) buffers_->index.emplace();
  const std::size_t ticks = options_.chunk_ticks;
  const std::size_t group_bytes =
      3 * k_chunk_header_bytes +
      InputEncoder::bytes_max(ticks, info_.player_count, info_.input_bytes) +
      ticks * sizeof(std::uint64_t) + k_event_buffer_bytes;
  const std::size_t beginning_bytes =
      k_max_written_header_bytes + k_chunk_header_bytes + config.size();
  const std::size_t index_bytes =
      options_.index ? k_chunk_header_bytes + k_max_index_bytes : std::size_t{0};
  buffers_->group.resize(std::max({group_bytes, beginning_bytes, index_bytes}));
  buffers_->hashes.reserve(ticks);
  buffers_->events.resize(k_event_buffer_bytes);
  if (options_.keyframe_bytes_max > 0) {
    buffers_->keyframe.resize(k_keyframe_prefix_bytes + options_.keyframe_bytes_max);
  }
}

Status Recorder::write_beginning(const LogHeader& header, ByteView config) {
  const std::span<std::byte> group(buffers_->group);
  const std::size_t header_bytes = file_header_bytes(header);
  buffers_->writer.begin(header, group);
  const Status status = append(group.first(header_bytes));
  if (status != Status::ok) return status;
  const std::span<std::byte> scene = group.first(k_chunk_header_bytes + config.size());
  std::copy(config.begin(), config.end(), scene.begin() + k_chunk_header_bytes);
  return append_packed({.type = ChunkType::scene, .first_tick = start_tick_}, scene);
}

void Recorder::start_chunk() {
  buffers_->hashes.clear();
  buffers_->inputs.start(std::span(buffers_->group).subspan(k_chunk_header_bytes),
                         info_.input_bytes);
}

Status Recorder::check_recording() const {
  if (state_ == State::recording) return Status::ok;
  return state_ == State::failed ? Status::io_error : Status::invalid_argument;
}

Status Recorder::record_commands(std::span<const PlayerCommand> commands) {
  Status status = check_recording();
  if (status != Status::ok || commands.empty()) return status;
  if (!buffers_->commands.takes(commands, info_.player_count)) return Status::invalid_argument;
  if (!buffers_->commands.has_room(commands)) status = flush();
  if (status == Status::ok) buffers_->commands.add(next_tick_, commands);
  return status;
}

Status Recorder::record_tick(std::uint64_t tick, std::span<const PlayerInput> inputs,
                             std::uint64_t hash) {
  const Status status = check_recording();
  if (status != Status::ok) return status;
  const bool has_start = start_tick_ == 0 || totals_.keyframes > 0;
  if (tick != next_tick_ || !has_start || !fits(info_, inputs)) return Status::invalid_argument;
  buffers_->inputs.add(inputs);
  buffers_->hashes.push_back(hash);
  buffers_->transcript.add(tick, inputs, buffers_->commands.next());
  buffers_->commands.note_tick();
  ++next_tick_;
  ++totals_.ticks;
  totals_.final_hash = hash;
  return buffers_->hashes.size() == options_.chunk_ticks ? flush() : Status::ok;
}

Status Recorder::record_step(const Simulation& stepped, std::span<const PlayerInput> inputs) {
  if (stepped.tick() != next_tick_ + 1) return Status::invalid_argument;
  const Status status = record_tick(next_tick_, inputs, stepped.hash());
  return status == Status::ok && keyframe_due() ? keyframe(stepped) : status;
}

bool Recorder::keyframe_due() const {
  if (state_ != State::recording || options_.keyframe_bytes_max == 0) return false;
  if (start_tick_ > 0 && totals_.keyframes == 0) return true;
  const std::uint64_t age = next_tick_ - start_tick_;
  const std::uint32_t interval = keyframe_interval(options_, age);
  return interval != 0 && next_tick_ != last_keyframe_tick_ && age % interval == 0;
}

Status Recorder::keyframe(const Simulation& simulation) {
  const Status status = check_recording();
  if (status != Status::ok) return status;
  if (simulation.tick() != next_tick_) return Status::invalid_argument;
  if (simulation.snapshot_bytes_max(SnapshotKind::canonical) > options_.keyframe_bytes_max) {
    return Status::capacity_exhausted;
  }
  const std::span<std::byte> room = std::span(buffers_->keyframe).subspan(k_keyframe_prefix_bytes);
  const std::size_t bytes = simulation.save(SnapshotKind::canonical, room);
  return write_keyframe(simulation.hash(), bytes);
}

Status Recorder::keyframe(std::uint64_t tick, std::uint64_t hash, ByteView snapshot) {
  const Status status = check_recording();
  if (status != Status::ok) return status;
  if (tick != next_tick_) return Status::invalid_argument;
  if (snapshot.size() > options_.keyframe_bytes_max) return Status::capacity_exhausted;
  std::copy(snapshot.begin(), snapshot.end(), buffers_->keyframe.begin() + k_keyframe_prefix_bytes);
  return write_keyframe(hash, snapshot.size());
}

Status Recorder::write_keyframe(std::uint64_t hash, std::size_t snapshot_bytes) {
  const bool repeated = totals_.keyframes > 0 && next_tick_ == last_keyframe_tick_;
  if (repeated || snapshot_bytes == 0 || (totals_.ticks > 0 && hash != totals_.final_hash)) {
    return Status::invalid_argument;
  }
  const Status status = flush();
  if (status != Status::ok) return status;
  const std::span<std::byte> chunk =
      std::span(buffers_->keyframe).first(k_keyframe_prefix_bytes + snapshot_bytes);
  ByteWriter(chunk.subspan(k_chunk_header_bytes)).put(hash);
  if (buffers_->index) buffers_->index->add({next_tick_, buffers_->writer.offset()});
  ++totals_.keyframes;
  last_keyframe_tick_ = next_tick_;
  const Status appended =
      append_packed({.type = ChunkType::keyframe, .first_tick = next_tick_}, chunk);
  return appended == Status::ok ? sign() : appended;
}

Status Recorder::event(std::uint64_t tick, EventKind kind, std::uint8_t slot,
                       std::string_view text) {
  Status status = check_recording();
  if (status != Status::ok) return status;
  if (kind == EventKind{0} || (slot != k_no_slot && slot >= info_.player_count)) {
    return Status::invalid_argument;
  }
  if (event_bytes(text) > k_event_buffer_bytes - buffers_->event_bytes) status = flush();
  if (status != Status::ok) return status;
  ByteWriter writer(std::span(buffers_->events).subspan(buffers_->event_bytes));
  encode_event(writer, tick, kind, slot, text);
  buffers_->event_bytes += writer.size();
  ++buffers_->event_count;
  ++totals_.events;
  return Status::ok;
}

Status Recorder::flush() {
  const Status status = check_recording();
  if (status != Status::ok) return status;
  if (!buffers_->commands.empty()) {
    const std::uint64_t first_tick = next_tick_ - buffers_->hashes.size();
    const Status appended = append(buffers_->commands.seal(buffers_->writer, first_tick));
    if (appended != Status::ok) return appended;
    buffers_->commands.restart();
  }
  const std::size_t tick_bytes = buffers_->hashes.empty() ? 0 : seal_ticks();
  const std::size_t used_bytes = buffers_->event_count == 0 ? tick_bytes : seal_events(tick_bytes);
  if (used_bytes == 0) return Status::ok;
  const Status appended = append(std::span(buffers_->group).first(used_bytes));
  start_chunk();
  return appended;
}

std::size_t Recorder::seal_ticks() {
  const std::span<std::byte> group(buffers_->group);
  const auto count = static_cast<std::uint32_t>(buffers_->hashes.size());
  const std::uint64_t first_tick = next_tick_ - count;
  const std::size_t input_bytes = k_chunk_header_bytes + buffers_->inputs.finish();
  buffers_->writer.seal({.type = ChunkType::input, .count = count, .first_tick = first_tick},
                        group.first(input_bytes));
  ByteWriter writer(group.subspan(input_bytes + k_chunk_header_bytes));
  for (std::uint64_t hash : buffers_->hashes)
    writer.put(hash);
  const std::size_t hash_bytes = k_chunk_header_bytes + writer.size();
  buffers_->writer.seal({.type = ChunkType::hash, .count = count, .first_tick = first_tick},
                        group.subspan(input_bytes, hash_bytes));
  return input_bytes + hash_bytes;
}

std::size_t Recorder::seal_events(std::size_t used_bytes) {
  const std::span<std::byte> chunk = std::span(buffers_->group)
                                         .subspan(used_bytes)
                                         .first(k_chunk_header_bytes + buffers_->event_bytes);
  std::copy_n(buffers_->events.begin(), buffers_->event_bytes,
              chunk.begin() + k_chunk_header_bytes);
  buffers_->writer.seal({.type = ChunkType::event,
                         .flags = k_flag_may_skip,
                         .count = buffers_->event_count,
                         .first_tick = next_tick_},
                        chunk);
  buffers_->event_bytes = 0;
  buffers_->event_count = 0;
  return used_bytes + chunk.size();
}

TranscriptHash Recorder::transcript() const {
  return buffers_ ? buffers_->transcript.value() : Transcript().value();
}

Status Recorder::finish(std::string_view reason, EndKind kind) {
  const Status status = flush();
  if (status != Status::ok) return status;
  totals_.final_tick = next_tick_;
  totals_.kind = kind;
  totals_.transcript = transcript();
  ChunkWriter& writer = buffers_->writer;
  const std::span<std::byte> group(buffers_->group);
  Status appended = Status::ok;
  if (buffers_->index) {
    appended = append(seal_index(writer, *buffers_->index, next_tick_, group));
  }
  if (appended == Status::ok) appended = append(seal_end(writer, totals_, reason, group));
  if (appended == Status::ok) appended = sign();
  if (appended == Status::ok) state_ = State::finished;
  return appended;
}

Status Recorder::append(ByteView bytes) {
  return note(buffers_->writer.append(bytes));
}

// Seals and appends a chunk, compressed where that makes it shorter.
Status Recorder::append_packed(ChunkHeader header, std::span<std::byte> chunk) {
  const ByteView raw = chunk.subspan(k_chunk_header_bytes);
  std::span<std::byte> packed;
  if (buffers_->compressor) packed = buffers_->compressor->compress(raw);
  if (!packed.empty()) {
    header.codec = Codec::zstd;
    header.raw_bytes = static_cast<std::uint32_t>(raw.size());
    chunk = packed;
  }
  buffers_->writer.seal(header, chunk);
  return append(chunk);
}

Status Recorder::sign() {
  if (!buffers_->writer.signs()) return Status::ok;
  return note(buffers_->writer.append_signature(next_tick_));
}

Status Recorder::note(Status status) {
  if (status != Status::ok) state_ = State::failed;
  return status;
}

}  // namespace lockstone::replay
