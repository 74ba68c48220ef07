#include "replay/codec/header_codec.h"

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/hash.h>
#include <lockstone/simulation_fields.h>
#include <lockstone/utf8.h>

#include "replay/bytes/log_digest.h"
#include "replay/codec/field_codec.h"
#include "replay/codec/index_codec.h"
#include "replay/codec/input_codec.h"
#include "replay/codec/record_codec.h"

namespace lockstone::replay {
namespace {

// A byte above 127, both line ends and a control-Z: a transfer as text changes one of them.
constexpr std::array<std::uint8_t, 8> k_magic{0x89, 'L', 'K', 'S', '\r', '\n', 0x1a, '\n'};

// Seeds keep the three kinds of checksum apart.
constexpr std::uint64_t k_file_seed = 1;
constexpr std::uint64_t k_frame_seed = 2;
constexpr std::uint64_t k_payload_seed = 3;

constexpr std::size_t k_frame_checksum_offset = k_chunk_header_bytes - k_checksum_bytes;

// The longest INPUT payload; tests relate it to InputEncoder::bytes_max.
constexpr std::size_t k_max_input_payload_bytes = 5U << 20;

// The integers of the header behind its simulation's, in the order of the file.
template <class Match, class Visit>
void visit_integers(Match& match, Visit visit) {
  visit(match.match_id);
  visit(match.seed);
  visit(match.start_tick);
}

// The fields of a chunk's frame behind the sync word and before its checksum, in the order of the
// file.
template <class Frame, class Visit>
void visit_frame(Frame& frame, Visit visit) {
  visit(frame.header.type);
  visit(frame.header.version);
  visit(frame.header.codec);
  visit(frame.header.flags);
  visit(frame.header.sequence);
  visit(frame.header.count);
  visit(frame.header.first_tick);
  visit(frame.header.raw_bytes);
  visit(frame.header.stored_bytes);
  visit(frame.previous);
  visit(frame.payload_checksum);
}

// The texts of the header, in the order of the file, with their limits.
template <class Match, class Visit>
void visit_texts(Match& match, Visit visit) {
  visit(match.build, k_max_build_bytes);
  visit(match.game, k_max_game_bytes);
  visit(match.game_version, k_max_game_bytes);
}

void put_text(ByteWriter& writer, std::string_view text, std::size_t limit) {
  const std::string_view cut = text.substr(0, limit);
  writer.put(static_cast<std::uint16_t>(cut.size()));
  put_as_text(writer, cut);
}

DecodeFault get_text(ByteReader& reader, std::string& text, std::size_t limit) {
  const std::size_t start = reader.position();
  const std::size_t length = reader.get<std::uint16_t>();
  if (length > limit) return malformed(start, "text of the header too long");
  const ByteView bytes = reader.get_bytes(length);
  if (!reader.ok()) return malformed(start, "text longer than the header");
  if (!is_text(bytes)) {
    return malformed(start + sizeof(std::uint16_t),
                     "control byte in a text of the header, or no UTF-8");
  }
  text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return {};
}

DecodeFault check_ranges(const LogHeader& header, std::uint16_t version) {
  const SimulationInfo& info = header.info;
  if (info.tick_rate == 0) return malformed(40, "tick rate is 0");
  const std::size_t most = version == k_oldest_format_version ? k_old_max_players : k_max_players;
  if (info.player_count == 0 || info.player_count > most) {
    return malformed(42, "player count out of range");
  }
  if (info.input_bytes == 0 || info.input_bytes > k_max_input_bytes) {
    return malformed(43, "input size out of range");
  }
  if (header.match.start_tick > k_max_start_tick) return malformed(64, "start tick out of range");
  return {};
}

DecodeFault check_limit(const ChunkHeader& header, std::size_t limit_bytes) {
  if (header.stored_bytes <= limit_bytes && header.raw_bytes <= limit_bytes) return {};
  return malformed(32, "announces a payload beyond the limit");
}

DecodeFault check_lengths(const ChunkHeader& header) {
  const DecodeFault fault = check_limit(header, max_payload_bytes(header.type));
  if (!fault.ok()) return fault;
  if (header.codec == Codec::raw && header.raw_bytes != header.stored_bytes) {
    return malformed(32, "raw and stored length differ without compression");
  }
  return {};
}

// The last eight bytes become the checksum of the others.
std::uint64_t seal(std::span<std::byte> bytes, std::uint64_t seed) {
  const auto covered = bytes.first(bytes.size() - k_checksum_bytes);
  const std::uint64_t checksum = hash64(covered, seed);
  ByteWriter(bytes.last(k_checksum_bytes)).put(checksum);
  return checksum;
}

}  // namespace

std::uint64_t seal_file_header(std::span<std::byte> header) {
  return seal(header, k_file_seed);
}

std::uint64_t seal_chunk_frame(std::span<std::byte, k_chunk_header_bytes> frame) {
  return seal(frame, k_frame_seed);
}

std::size_t file_header_bytes(const LogHeader& header) {
  std::size_t bytes = k_min_file_header_bytes;
  visit_texts(header.match, [&](const std::string& text, std::size_t limit) {
    bytes += std::min(text.size(), limit);
  });
  return bytes;
}

std::uint64_t encode_file_header(const LogHeader& header, std::span<std::byte> out) {
  const std::size_t total_bytes = file_header_bytes(header);
  ByteWriter writer(out.first(total_bytes));
  for (std::uint8_t byte : k_magic)
    writer.put(byte);
  writer.put(k_format_version);
  writer.put(static_cast<std::uint16_t>(total_bytes));
  visit_fields(header.info, put_with(writer));
  writer.put(std::uint32_t{0});
  visit_integers(header.match, put_with(writer));
  visit_texts(header.match,
              [&](const std::string& text, std::size_t limit) { put_text(writer, text, limit); });
  LKS_CHECK(writer.ok() && writer.size() == total_bytes - k_checksum_bytes);
  return seal_file_header(out.first(total_bytes));
}

DecodeFault decode_file_prefix(ByteView prefix, std::size_t& header_bytes) {
  ByteReader reader(prefix);
  for (std::uint8_t byte : k_magic) {
    const std::size_t position = reader.position();
    if (reader.get<std::uint8_t>() != byte) return malformed(position, "not a Lockstone log");
  }
  (void)reader.get<std::uint16_t>();  // the version counts once the checksum has been seen
  header_bytes = reader.get<std::uint16_t>();
  if (header_bytes < k_min_file_header_bytes || header_bytes > k_max_file_header_bytes) {
    return malformed(10, "file header length out of range");
  }
  return {};
}

DecodeFault decode_file_header(ByteView bytes, LogHeader& header, std::uint64_t& checksum) {
  const ByteView covered = bytes.first(bytes.size() - k_checksum_bytes);
  checksum = ByteReader(bytes.last(k_checksum_bytes)).get<std::uint64_t>();
  if (hash64(covered, k_file_seed) != checksum) {
    return {Status::checksum_mismatch, 0, "file header: wrong checksum"};
  }
  ByteReader reader(covered);
  (void)reader.get_bytes(k_magic.size());
  const auto version = reader.get<std::uint16_t>();
  if (version < k_oldest_format_version || version > k_format_version) {
    return {Status::unsupported_version, 8,
            "of another format version than this build reads; record it again"};
  }
  (void)reader.get<std::uint16_t>();
  visit_fields(header.info, get_with(reader));
  if (reader.get<std::uint32_t>() != 0) return malformed(44, "reserved bytes are not 0");
  visit_integers(header.match, get_with(reader));
  DecodeFault fault;
  visit_texts(header.match, [&](std::string& text, std::size_t limit) {
    if (fault.ok()) fault = get_text(reader, text, limit);
  });
  if (!fault.ok()) return fault;
  if (reader.remaining() != 0) return malformed(reader.position(), "bytes after the last text");
  return check_ranges(header, version);
}

std::uint64_t payload_checksum(ByteView stored) {
  return hash64(stored, k_payload_seed);
}

std::uint64_t encode_chunk_frame(const ChunkFrame& frame,
                                 std::span<std::byte, k_chunk_header_bytes> out) {
  ByteWriter writer(out);
  writer.put(k_chunk_sync);
  visit_frame(frame, put_with(writer));
  LKS_CHECK(writer.ok() && writer.size() == k_frame_checksum_offset);
  return seal_chunk_frame(out);
}

DecodeFault decode_chunk_frame(std::span<const std::byte, k_chunk_header_bytes> bytes,
                               ChunkFrame& frame) {
  ByteReader reader(bytes);
  if (reader.get<std::uint32_t>() != k_chunk_sync) {
    return {Status::checksum_mismatch, 0, "no chunk begins here"};
  }
  const ChunkHeader& header = frame.header;
  visit_frame(frame, get_with(reader));
  frame.checksum = reader.get<std::uint64_t>();
  if (hash64(bytes.first(k_frame_checksum_offset), k_frame_seed) != frame.checksum) {
    return {Status::checksum_mismatch, 0, "wrong checksum"};
  }
  if ((header.flags & ~k_flag_may_skip) != 0) {
    return {Status::unsupported_version, 7, "unknown flags"};
  }
  return check_lengths(header);
}

std::size_t max_payload_bytes(ChunkType type) {
  switch (type) {
    case ChunkType::scene:
      return k_max_scene_bytes;
    case ChunkType::input:
      return k_max_input_payload_bytes;
    case ChunkType::hash:
      return k_max_chunk_ticks * sizeof(std::uint64_t);
    case ChunkType::event:
      return 1U << 20;
    case ChunkType::end:
      return k_end_fixed_bytes + k_max_text_bytes;
    case ChunkType::keyframe:
      return k_max_keyframe_bytes + sizeof(std::uint64_t);
    case ChunkType::index:
      return k_max_index_bytes;
    case ChunkType::signature:
      return k_signature_bytes;
    case ChunkType::command:
      return k_max_command_chunk_bytes;
    default:
      return k_max_keyframe_bytes;
  }
}

std::size_t max_payload_bytes(ChunkType type, const SimulationInfo& info) {
  const std::size_t ticks = max_chunk_ticks(info);
  if (type == ChunkType::hash) return ticks * sizeof(std::uint64_t);
  if (type != ChunkType::input) return max_payload_bytes(type);
  return InputEncoder::bytes_max(ticks, info.player_count, info.input_bytes);
}

std::size_t max_chunk_ticks(const SimulationInfo& info) {
  return std::min<std::size_t>(info.tick_rate, k_max_chunk_ticks);
}

DecodeFault check_bounds(const ChunkHeader& chunk, const SimulationInfo& info) {
  const DecodeFault fault = check_limit(chunk, max_payload_bytes(chunk.type, info));
  if (!fault.ok()) return fault;
  const bool may_be_compressed =
      chunk.type == ChunkType::scene || chunk.type == ChunkType::keyframe || !is_known(chunk.type);
  if (chunk.codec == Codec::zstd && !may_be_compressed) {
    return malformed(6, "compressed, which only SCENE and KEYFRAME may be");
  }
  return {};
}

bool is_known(ChunkType type) {
  return (type >= ChunkType::scene && type <= ChunkType::event) || type == ChunkType::end ||
         type == ChunkType::command;
}

}  // namespace lockstone::replay
