// Appends chunks to a sink: fills in frames, chains them, counts bytes, signs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <lockstone/replay/format.h>
#include <lockstone/replay/sink.h>

#include "replay/bytes/log_digest.h"

namespace lockstone::replay {

class ChunkWriter {
 public:
  explicit ChunkWriter(Sink& sink) : sink_(sink) {}

  /// Signs from here on; before anything is written.
  void set_key(const SigningKey& key) {
    key_ = key;
    digest_.emplace();
  }
  [[nodiscard]] bool signs() const { return key_.has_value(); }

  /// Goes on behind a log's last chunk, whose frame has this sequence number and checksum. Without
  /// a key: the earlier bytes were not seen.
  void continue_at(std::uint64_t offset, std::uint32_t next_sequence, std::uint64_t previous) {
    offset_ = offset;
    sequence_ = next_sequence;
    previous_ = previous;
  }

  /// Writes the file header into `out`, which has file_header_bytes().
  void begin(const LogHeader& header, std::span<std::byte> out);

  /// Fills in the frame in front of a stored payload that already stands in its place.
  /// `header.raw_bytes` is the payload's length before compression, 0: it is not compressed.
  void seal(ChunkHeader header, std::span<std::byte> chunk);

  /// Hands sealed chunks over, in their order.
  Status append(ByteView bytes);

  /// Signs all that was appended.
  Status append_signature(std::uint64_t tick);

  /// Where the next byte goes.
  [[nodiscard]] std::uint64_t offset() const { return offset_; }

 private:
  Sink& sink_;
  std::uint64_t offset_ = 0;
  std::uint64_t previous_ = 0;
  std::uint32_t sequence_ = 0;
  std::optional<SigningKey> key_;
  std::optional<LogDigest> digest_;
};

/// The bytes of an INDEX chunk, for seal() and append(); `out` has the frame and k_max_index_bytes.
class IndexBuilder;
[[nodiscard]] std::span<std::byte> seal_index(ChunkWriter& writer, const IndexBuilder& index,
                                              std::uint64_t tick, std::span<std::byte> out);

/// The bytes of an END chunk; `out` has the frame, k_end_fixed_bytes and k_max_text_bytes.
[[nodiscard]] std::span<std::byte> seal_end(ChunkWriter& writer, const LogEnd& end,
                                            std::string_view reason, std::span<std::byte> out);

}  // namespace lockstone::replay
