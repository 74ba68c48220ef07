// Walks the chunks of a log and checks everything that needs no knowledge of their content: frames,
// checksums, sequence, the chain from each chunk to the one before it, lengths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/replay/format.h>
#include <lockstone/replay/source.h>

#include "replay/chunks/chunk_chain.h"
#include "replay/codec/decode_fault.h"
#include "replay/codec/header_codec.h"

namespace lockstone::replay {

enum class Walk : std::uint8_t {
  good,      ///< the header, the frame or the payload asked for was read
  finished,  ///< the log ends where a chunk would begin
  torn,      ///< the log ends inside a chunk
  damaged,
};

/// Holds one frame and its payload. Nothing is accepted that a checksum or the chain contradicts;
/// every rejection leaves its place and reason in `damage`.
class ChunkReader {
 public:
  explicit ChunkReader(Source& source) : source_(source) {}

  /// Reads the file header: good or damaged. First, once.
  [[nodiscard]] Walk open();

  /// Reads the next chunk's frame; the payload of the one before may be left unread.
  [[nodiscard]] Walk next_frame();

  /// Goes on with the chunk at `offset`, whose sequence number and chain are then taken as they
  /// are. malformed for an offset beyond the log.
  Status jump(std::uint64_t offset);

  /// Sets the greatest size of the simulation's snapshots: longer ones are refused from here on.
  void bound_snapshots(std::size_t bytes) { snapshot_bytes_max_ = bytes; }

  /// Reads the stored payload of the chunk whose frame was read: good or damaged.
  [[nodiscard]] Walk read_payload();

  /// Decompresses the payload that was read, if its codec says so: good or damaged.
  [[nodiscard]] Walk unpack();

  /// Reports damage found in the current chunk's payload, at the fault's place in it.
  void reject_payload(const DecodeFault& fault);

  /// Reports that the current chunk as a whole is not acceptable.
  void reject_chunk(Status status, const char* what);

  /// Reports that from the current chunk's place on there should be nothing.
  void reject_rest();

  [[nodiscard]] const LogHeader& log() const { return log_; }
  [[nodiscard]] const ChunkHeader& chunk() const { return frame_.header; }
  [[nodiscard]] std::uint64_t chunk_offset() const { return chunk_offset_; }
  /// Where the next chunk begins, and the predecessor's checksum that it must name.
  [[nodiscard]] std::uint64_t next_offset() const { return chain_.next_offset(); }
  [[nodiscard]] std::uint64_t last_checksum() const { return chain_.checksum(); }
  [[nodiscard]] ByteView payload() const { return payload_; }

  /// The last damage that was reported; Status::ok before that.
  [[nodiscard]] const Damage& damage() const { return damage_; }

 private:
  [[nodiscard]] std::uint64_t remaining() const { return source_.size() - next_offset(); }
  [[nodiscard]] std::string name_chunk() const;
  Walk reject(Status status, std::string what);
  Walk reject_file(const DecodeFault& fault);
  Walk report(Walk walk, Damage damage);
  Walk read_error();
  Walk torn(ChunkType type, std::string what);
  Walk check_place();

  Source& source_;
  LogHeader log_;
  ChunkFrame frame_;
  std::vector<std::byte> payload_;
  std::vector<std::byte> unpacked_;
  ChunkChain chain_;
  std::uint64_t chunk_offset_ = 0;  ///< of the current chunk
  std::size_t snapshot_bytes_max_ = k_max_keyframe_bytes;
  Damage damage_;
};

}  // namespace lockstone::replay
