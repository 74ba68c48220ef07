// The chain of a log's chunks: each names its own number and the checksum of the one before it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <lockstone/bytes.h>

#include "replay/codec/header_codec.h"

namespace lockstone::replay {

/// The place where the next chunk must stand, and its links to the one before.
class ChunkChain {
 public:
  /// A break of the chain.
  struct Break {
    Status status = Status::ok;
    std::string reason;
  };

  /// The first chunk stands at `offset` and names `checksum`, the file header's.
  void begin(std::uint64_t offset, std::uint64_t checksum);

  /// The next chunk stands at `offset`; its number and link are taken as they are.
  void jump(std::uint64_t offset);

  /// Checks the links of the chunk that was read at `next_offset`. `name` is its name for people.
  [[nodiscard]] std::optional<Break> check(const ChunkFrame& frame, const std::string& name);

  /// Steps over a chunk that was checked.
  void advance(const ChunkFrame& frame);

  [[nodiscard]] std::uint64_t next_offset() const { return offset_; }
  [[nodiscard]] std::uint32_t next_sequence() const { return sequence_; }
  /// The checksum that the next chunk must name.
  [[nodiscard]] std::uint64_t checksum() const { return checksum_; }

 private:
  std::uint64_t offset_ = 0;
  std::uint64_t checksum_ = 0;
  std::uint32_t sequence_ = 0;
  bool jumped_ = false;  ///< the next chunk is the first after a jump
};

}  // namespace lockstone::replay
