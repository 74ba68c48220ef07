#include "replay/chunks/chunk_writer.h"

#include <array>

#include "replay/codec/header_codec.h"
#include "replay/codec/index_codec.h"
#include "replay/codec/record_codec.h"

namespace lockstone::replay {

void ChunkWriter::begin(const LogHeader& header, std::span<std::byte> out) {
  previous_ = encode_file_header(header, out);
}

void ChunkWriter::seal(ChunkHeader header, std::span<std::byte> chunk) {
  const ByteView payload = chunk.subspan(k_chunk_header_bytes);
  header.sequence = sequence_++;
  header.stored_bytes = static_cast<std::uint32_t>(payload.size());
  if (header.codec == Codec::raw) header.raw_bytes = header.stored_bytes;
  const ChunkFrame frame{header, previous_, payload_checksum(payload), 0};
  previous_ = encode_chunk_frame(frame, chunk.first<k_chunk_header_bytes>());
}

Status ChunkWriter::append(ByteView bytes) {
  offset_ += bytes.size();
  if (digest_) digest_->update(bytes);
  return sink_.append(bytes);
}

Status ChunkWriter::append_signature(std::uint64_t tick) {
  std::array<std::byte, k_chunk_header_bytes + k_signature_bytes> chunk{};
  digest_->sign(*key_, std::span(chunk).last<k_signature_bytes>());
  seal({.type = ChunkType::signature, .flags = k_flag_may_skip, .first_tick = tick}, chunk);
  return append(chunk);
}

std::span<std::byte> seal_index(ChunkWriter& writer, const IndexBuilder& index, std::uint64_t tick,
                                std::span<std::byte> out) {
  ByteWriter payload(out.subspan(k_chunk_header_bytes));
  encode_index(payload, index.places(), writer.offset());
  const std::span<std::byte> chunk = out.first(k_chunk_header_bytes + payload.size());
  writer.seal({.type = ChunkType::index, .flags = k_flag_may_skip, .first_tick = tick}, chunk);
  return chunk;
}

std::span<std::byte> seal_end(ChunkWriter& writer, const LogEnd& end, std::string_view reason,
                              std::span<std::byte> out) {
  ByteWriter payload(out.subspan(k_chunk_header_bytes));
  encode_end(payload, end, reason);
  const std::span<std::byte> chunk = out.first(k_chunk_header_bytes + payload.size());
  writer.seal({.type = ChunkType::end, .first_tick = end.final_tick}, chunk);
  return chunk;
}

}  // namespace lockstone::replay
