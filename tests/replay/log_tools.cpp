#include "tests/replay/log_tools.h"

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/replay/log_reader.h>

namespace lockstone::test {

using namespace replay;

ToyInputs::ToyInputs(const ToyConfig& config)
    : config_(config), bytes_(std::size_t{config.player_count} * config.input_bytes) {
  inputs_.resize(config.player_count);
}

std::span<const PlayerInput> ToyInputs::at(std::uint64_t tick) {
  for (std::size_t slot = 0; slot < inputs_.size(); ++slot) {
    const auto bytes = std::span(bytes_).subspan(slot * config_.input_bytes, config_.input_bytes);
    const auto origin = static_cast<InputOrigin>((tick / 3 + slot) % 7 % 4);
    const bool silent = origin == InputOrigin::neutral || origin == InputOrigin::absent;
    toy_input(config_.seed, slot, tick, bytes);
    if (silent) std::fill(bytes.begin(), bytes.end(), std::byte{0});
    inputs_[slot] = {bytes, origin};
  }
  return inputs_;
}

std::span<const PlayerCommand> ToyCommands::at(std::uint64_t tick) {
  commands_.clear();
  if (match_.command_every == 0 || tick % match_.command_every != 0) return {};
  bytes_.resize(match_.command_bytes);
  for (std::size_t i = 0; i < bytes_.size(); ++i)
    bytes_[i] = static_cast<std::byte>(7 * tick + i);
  const std::uint64_t turn = tick / match_.command_every;
  if (turn % 2 == 1) commands_.push_back({k_server_slot, ByteView(bytes_).first(1)});
  commands_.push_back({static_cast<std::uint8_t>(turn % match_.config.player_count), bytes_});
  return commands_;
}

Status record(const ToyMatch& match, Sink& sink) {
  ToySimulation game(match.config);
  ToyInputs inputs(match.config);
  ToyCommands commands(match);
  while (game.tick() < match.start_tick)
    step_tick(game, inputs.at(game.tick()), commands.at(game.tick()));
  Recorder recorder(sink, {.keyframe_interval_ticks = match.keyframe_interval,
                           .chunk_ticks = match.chunk_ticks,
                           .keyframe_bytes_max = game.snapshot_bytes_max(SnapshotKind::canonical),
                           .compress = match.compress,
                           .index = match.index,
                           .signing_key = match.signing_key});
  Status status = recorder.begin(game.info(), match.config.encode(),
                                 {.match_id = 7,
                                  .seed = match.config.seed,
                                  .start_tick = match.start_tick,
                                  .build = "toy 1",
                                  .game = "toy",
                                  .game_version = "1.0"});
  if (status == Status::ok && match.start_tick > 0) status = recorder.keyframe(game);
  for (std::uint64_t i = 0; i < match.ticks && status == Status::ok; ++i) {
    const std::uint64_t tick = game.tick();
    step_tick(game, inputs.at(tick), commands.at(tick));
    if (match.flip_at == tick) LKS_CHECK(game.flip_bit("body", 1, "position.x", 0));
    if (match.has_events && tick % 9 == 0) {
      status = recorder.event(tick, EventKind::join, 1, "player one");
    }
    if (status == Status::ok) status = recorder.record_commands(commands.at(tick));
    if (status == Status::ok) status = recorder.record_step(game, inputs.at(tick));
  }
  if (status == Status::ok && match.finishes) status = recorder.finish("match over");
  return status;
}

Bytes record(const ToyMatch& match) {
  MemorySink sink;
  LKS_CHECK(record(match, sink) == Status::ok);
  return sink.bytes();
}

std::vector<ChunkPlace> chunks_of(const Bytes& log) {
  std::vector<ChunkPlace> chunks;
  std::size_t offset = 0;
  LKS_CHECK(decode_file_prefix(std::span(log).first(k_file_prefix_bytes), offset).ok());
  while (offset < log.size()) {
    ChunkPlace place{.offset = offset, .bytes = 0, .frame = {}};
    const auto frame = std::span(log).subspan(offset).first<k_chunk_header_bytes>();
    // A length beyond the limit is read all the same: some tests put one there.
    const Status status = decode_chunk_frame(frame, place.frame).status;
    LKS_CHECK(status == Status::ok || status == Status::malformed);
    place.bytes = k_chunk_header_bytes + place.frame.header.stored_bytes;
    offset += place.bytes;
    chunks.push_back(place);
  }
  return chunks;
}

std::size_t find_chunk(const std::vector<ChunkPlace>& chunks, ChunkType type, std::size_t nth) {
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (chunks[i].frame.header.type == type && nth-- == 0) return i;
  }
  LKS_CHECK(false);
  return 0;
}

void set_frame(Bytes& log, const ChunkPlace& place, const ChunkFrame& frame) {
  encode_chunk_frame(frame, std::span(log).subspan(place.offset).first<k_chunk_header_bytes>());
}

void relink(Bytes& log) {
  LogHeader header;
  std::uint64_t previous = 0;
  std::size_t header_bytes = 0;
  LKS_CHECK(decode_file_prefix(std::span(log).first(k_file_prefix_bytes), header_bytes).ok());
  LKS_CHECK(decode_file_header(std::span(log).first(header_bytes), header, previous).ok());
  std::uint32_t sequence = 0;
  for (ChunkPlace place : chunks_of(log)) {
    place.frame.header.sequence = sequence++;
    place.frame.previous = previous;
    place.frame.payload_checksum = payload_checksum(
        std::span(log).subspan(place.offset, place.bytes).subspan(k_chunk_header_bytes));
    previous = encode_chunk_frame(
        place.frame, std::span(log).subspan(place.offset).first<k_chunk_header_bytes>());
  }
}

namespace {

// Holds altered inputs of one tick.
class Alteration {
 public:
  Alteration(const AlterInput& alter, const SimulationInfo& info)
      : alter_(alter), input_bytes_(info.input_bytes) {
    bytes_.resize(info.player_count * input_bytes_);
    inputs_.resize(info.player_count);
  }

  std::span<const PlayerInput> apply(std::uint64_t tick, std::span<const PlayerInput> inputs) {
    for (std::size_t slot = 0; slot < inputs.size(); ++slot) {
      const auto bytes = std::span(bytes_).subspan(slot * input_bytes_, input_bytes_);
      std::copy(inputs[slot].bytes.begin(), inputs[slot].bytes.end(), bytes.begin());
      if (alter_) alter_(tick, slot, bytes);
      inputs_[slot] = {bytes, inputs[slot].origin};
    }
    return inputs_;
  }

 private:
  const AlterInput& alter_;
  std::size_t input_bytes_;
  Bytes bytes_;
  std::vector<PlayerInput> inputs_;
};

Status write_ticks(Recorder& recorder, const LogReader& reader, Alteration& alteration) {
  Status status = Status::ok;
  for (std::size_t i = 0; i < reader.hashes().size() && status == Status::ok; ++i) {
    const std::uint64_t tick = reader.chunk().first_tick + i;
    status = recorder.record_commands(reader.tick_commands(i));
    if (status != Status::ok) return status;
    status = recorder.record_tick(tick, alteration.apply(tick, reader.tick_inputs(i)),
                                  reader.hashes()[i]);
  }
  return status == Status::ok ? recorder.flush() : status;
}

Status write_item(Recorder& recorder, const LogReader& reader, LogItem item,
                  Alteration& alteration) {
  Status status = Status::ok;
  switch (item) {
    case LogItem::scene:
      return recorder.begin(reader.header().info, reader.config(), reader.header().match);
    case LogItem::hashes:
      return write_ticks(recorder, reader, alteration);
    case LogItem::keyframe:
      return recorder.keyframe(reader.chunk().first_tick, reader.keyframe_hash(),
                               reader.snapshot());
    case LogItem::events:
      for (const LogEvent& event : reader.events()) {
        if (status == Status::ok) {
          status = recorder.event(event.tick, event.kind, event.slot, event.text);
        }
      }
      return status == Status::ok ? recorder.flush() : status;
    case LogItem::end:
      return recorder.finish(reader.end().reason);
    default:
      return Status::ok;
  }
}

}  // namespace

Bytes rewrite(const Bytes& log, const AlterInput& alter) {
  MemorySource source(log);
  LogReader reader(source);
  LKS_CHECK(reader.open() == Status::ok);
  Alteration alteration(alter, reader.header().info);
  MemorySink sink;
  Recorder recorder(sink, {.keyframe_bytes_max = 1U << 20, .compress = false, .index = false});
  for (LogItem item = reader.next(); !is_last(item); item = reader.next()) {
    LKS_CHECK(write_item(recorder, reader, item, alteration) == Status::ok);
  }
  return sink.bytes();
}

VerifyReport verify_toy(const Bytes& log, const VerifyOptions& options) {
  MemorySource source(log);
  return verify(source, toy_factory(), options);
}

}  // namespace lockstone::test
