// The file header and the chunk frame as bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/replay/format.h>

#include "replay/codec/decode_fault.h"

namespace lockstone::replay {

/// In every format version: magic, version and length come first, the checksum last.
inline constexpr std::size_t k_file_prefix_bytes = 12;
inline constexpr std::size_t k_file_fixed_bytes = 72;  ///< up to the texts
inline constexpr std::size_t k_file_texts = 3;         ///< each with its length, u16
inline constexpr std::size_t k_checksum_bytes = 8;
inline constexpr std::size_t k_min_file_header_bytes =
    k_file_fixed_bytes + k_file_texts * sizeof(std::uint16_t) + k_checksum_bytes;
inline constexpr std::size_t k_max_written_header_bytes =
    k_min_file_header_bytes + k_max_build_bytes + 2 * k_max_game_bytes;

/// Bytes that encode_file_header() writes.
[[nodiscard]] std::size_t file_header_bytes(const LogHeader& header);

/// Writes the header, with its texts cut to their limits; returns its checksum, which the first
/// chunk names as its predecessor's. `out` has file_header_bytes() bytes.
std::uint64_t encode_file_header(const LogHeader& header, std::span<std::byte> out);

/// Reads magic and length from the first k_file_prefix_bytes.
[[nodiscard]] DecodeFault decode_file_prefix(ByteView prefix, std::size_t& header_bytes);

/// Reads the whole header: `bytes` is as long as the prefix said.
[[nodiscard]] DecodeFault decode_file_header(ByteView bytes, LogHeader& header,
                                             std::uint64_t& checksum);

/// A chunk's frame with the checksums of its payload and of the chunk before it.
struct ChunkFrame {
  ChunkHeader header;
  std::uint64_t previous = 0;  ///< checksum of the frame before, or of the file header
  std::uint64_t payload_checksum = 0;
  std::uint64_t checksum = 0;  ///< of the frame itself; covers the two above
};

[[nodiscard]] std::uint64_t payload_checksum(ByteView stored);

/// The four bytes that a frame begins with, little-endian: a7 'L' 'K' 'C'.
inline constexpr std::uint32_t k_chunk_sync = 0x434b4ca7;

/// Put the checksum of all before it at the end of a file header, of a frame; and return it.
std::uint64_t seal_file_header(std::span<std::byte> header);
std::uint64_t seal_chunk_frame(std::span<std::byte, k_chunk_header_bytes> frame);

/// Writes the frame and returns its checksum. `frame.checksum` is not read.
std::uint64_t encode_chunk_frame(const ChunkFrame& frame,
                                 std::span<std::byte, k_chunk_header_bytes> out);

/// Checks sync word, checksum, flags, and lengths by the limits of any log.
[[nodiscard]] DecodeFault decode_chunk_frame(std::span<const std::byte, k_chunk_header_bytes> bytes,
                                             ChunkFrame& frame);

/// The longest payload that a chunk of this type may announce in any log, and in one with this
/// header.
[[nodiscard]] std::size_t max_payload_bytes(ChunkType type);
[[nodiscard]] std::size_t max_payload_bytes(ChunkType type, const SimulationInfo& info);

/// The most ticks of a chunk: one second, and at most k_max_chunk_ticks.
[[nodiscard]] std::size_t max_chunk_ticks(const SimulationInfo& info);

/// Checks lengths and codec by the limits of a log with this header.
[[nodiscard]] DecodeFault check_bounds(const ChunkHeader& chunk, const SimulationInfo& info);

[[nodiscard]] bool is_known(ChunkType type);

}  // namespace lockstone::replay
