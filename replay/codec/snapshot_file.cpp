#include <lockstone/assert.h>
#include <lockstone/hash.h>
#include <lockstone/replay/format.h>
#include <lockstone/replay/snapshot_file.h>

#include "replay/codec/compression.h"

namespace lockstone::replay {
namespace {

constexpr std::uint32_t k_snapshot_magic = 0x53534b4c;  // "LKSS"
constexpr std::uint16_t k_version = 2;
constexpr std::size_t k_front_bytes = 4 + 2 + 1 + 1 + 4 + 4;
constexpr std::size_t k_end_bytes = 8;

}  // namespace

std::vector<std::byte> pack_snapshot(ByteView canonical) {
  if (canonical.size() > k_max_keyframe_bytes)
    misused("replay::pack_snapshot: the snapshot is above k_max_keyframe_bytes");
  Compressor compressor(canonical.size());
  const std::span<std::byte> room = compressor.compress(canonical);
  const ByteView stored = room.empty() ? canonical : ByteView(room.subspan(k_chunk_header_bytes));
  std::vector<std::byte> file(k_front_bytes + stored.size() + k_end_bytes);
  ByteWriter writer(file);
  writer.put(k_snapshot_magic);
  writer.put(k_version);
  writer.put(room.empty() ? Codec::raw : Codec::zstd);
  writer.put(std::uint8_t{0});
  writer.put(static_cast<std::uint32_t>(canonical.size()));
  writer.put(static_cast<std::uint32_t>(stored.size()));
  writer.put_bytes(stored);
  writer.put(hash64(writer.written()));
  LKS_CHECK(writer.ok() && writer.size() == file.size());
  return file;
}

Result<std::vector<std::byte>> unpack_snapshot(ByteView file) {
  ByteReader reader(file);
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  const auto codec = static_cast<Codec>(reader.get<std::uint8_t>());
  const auto reserved = reader.get<std::uint8_t>();
  const auto raw_bytes = reader.get<std::uint32_t>();
  const auto stored_bytes = reader.get<std::uint32_t>();
  const ByteView stored = reader.get_bytes(stored_bytes);
  const std::size_t covered = reader.position();
  const auto checksum = reader.get<std::uint64_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_snapshot_magic) return Status::malformed;
  if (version != k_version) return Status::unsupported_version;
  if (reader.remaining() != 0 || reserved != 0 || codec > Codec::zstd ||
      raw_bytes > k_max_keyframe_bytes) {
    return Status::malformed;
  }
  if (checksum != hash64(file.first(covered))) return Status::checksum_mismatch;
  if (codec == Codec::raw) {
    if (raw_bytes != stored_bytes) return Status::malformed;
    return std::vector<std::byte>(stored.begin(), stored.end());
  }
  std::vector<std::byte> raw;
  const DecodeFault fault = decompress(stored, raw_bytes, raw);
  if (!fault.ok()) return fault.status;
  return raw;
}

}  // namespace lockstone::replay
