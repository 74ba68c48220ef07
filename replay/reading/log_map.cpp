#include <algorithm>
#include <array>
#include <optional>

#include <lockstone/replay/log_map.h>

#include "replay/chunks/chunk_reader.h"
#include "replay/codec/index_codec.h"
#include "replay/codec/record_codec.h"

namespace lockstone::replay {
namespace {

// An END and a SIGNATURE behind it fit.
constexpr std::size_t k_tail_bytes = 1024;

std::optional<ChunkFrame> frame_at(Source& source, std::uint64_t offset) {
  std::array<std::byte, k_chunk_header_bytes> bytes{};
  if (offset > source.size() || source.size() - offset < bytes.size()) return std::nullopt;
  ChunkFrame frame;
  const bool good =
      source.read_at(offset, bytes) == Status::ok && decode_chunk_frame(bytes, frame).ok();
  return good ? std::optional(frame) : std::nullopt;
}

// Where the END begins: the checksum of its frame tells it from bytes that only look like one.
std::optional<std::uint64_t> find_end(Source& source) {
  const std::uint64_t size = source.size();
  const std::uint64_t from = size > k_tail_bytes ? size - k_tail_bytes : 0;
  for (std::uint64_t offset = from; offset + k_chunk_header_bytes <= size; ++offset) {
    const std::optional<ChunkFrame> frame = frame_at(source, offset);
    if (frame && frame->header.type == ChunkType::end) return offset;
  }
  return std::nullopt;
}

// The index is the chunk before the END; its last eight bytes say where it begins.
std::optional<std::uint64_t> find_index(Source& source) {
  const std::optional<std::uint64_t> end = find_end(source);
  std::array<std::byte, sizeof(std::uint64_t)> bytes{};
  if (!end || *end < bytes.size()) return std::nullopt;
  if (source.read_at(*end - bytes.size(), bytes) != Status::ok) return std::nullopt;
  const auto offset = ByteReader(bytes).get<std::uint64_t>();
  const std::optional<ChunkFrame> frame = frame_at(source, offset);
  if (!frame || frame->header.type != ChunkType::index) return std::nullopt;
  const std::uint64_t chunk_bytes = k_chunk_header_bytes + frame->header.stored_bytes;
  return *end - offset == chunk_bytes ? std::optional(offset) : std::nullopt;
}

KeyframePlace last_before(std::span<const KeyframePlace> places, std::uint64_t tick, bool& found) {
  const auto after = std::partition_point(places.begin(), places.end(),
                                          [&](const KeyframePlace& p) { return p.tick <= tick; });
  found = after != places.begin();
  return found ? *(after - 1) : KeyframePlace{};
}

}  // namespace

LogMap map_log(Source& source) {
  LogMap map;
  ChunkReader chunks(source);
  if (chunks.open() != Walk::good) return map;
  while (chunks.next_frame() == Walk::good) {
    const ChunkHeader& chunk = chunks.chunk();
    if (chunk.type == ChunkType::hash) map.ticks += chunk.count;
    if (chunk.type == ChunkType::keyframe) {
      map.keyframes.push_back({chunk.first_tick, chunks.chunk_offset()});
    }
  }
  return map;
}

Result<std::vector<KeyframePlace>> read_index(Source& source) {
  const std::optional<std::uint64_t> offset = find_index(source);
  if (!offset) return Status::not_found;
  ChunkReader chunks(source);
  if (chunks.open() != Walk::good) return chunks.damage().status;
  if (chunks.jump(*offset) != Status::ok || chunks.next_frame() != Walk::good ||
      chunks.read_payload() != Walk::good) {
    return chunks.damage().status;
  }
  const bool known =
      chunks.chunk().version == k_chunk_version && chunks.chunk().codec == Codec::raw;
  if (!known) return Status::unsupported_version;
  std::vector<KeyframePlace> places;
  const DecodeFault fault = decode_index(chunks.payload(), *offset, places);
  if (!fault.ok()) return fault.status;
  return places;
}

Result<KeyframePlace> find_keyframe(Source& source, std::uint64_t tick) {
  bool found = false;
  if (const auto index = read_index(source); index.ok()) {
    const KeyframePlace place = last_before(index.value(), tick, found);
    const std::optional<ChunkFrame> frame = found ? frame_at(source, place.offset) : std::nullopt;
    const bool right = frame && frame->header.type == ChunkType::keyframe &&
                       frame->header.first_tick == place.tick;
    if (right) return place;
  }
  const KeyframePlace place = last_before(map_log(source).keyframes, tick, found);
  if (!found) return Status::not_found;
  return place;
}

}  // namespace lockstone::replay
