// Payloads made smaller with Zstandard, where the library was there when this was built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/replay/format.h>

#include "replay/codec/decode_fault.h"

namespace lockstone::replay {

/// Whether this many stored bytes may stand for this many raw ones.
[[nodiscard]] inline bool within_ratio(std::size_t stored_bytes, std::size_t raw_bytes) {
  const std::size_t rest = raw_bytes % k_max_compression_ratio == 0 ? 0 : 1;
  return raw_bytes / k_max_compression_ratio + rest <= stored_bytes;
}

class Compressor {
 public:
  /// Takes all memory that payloads up to `raw_bytes_max` need.
  explicit Compressor(std::size_t raw_bytes_max);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  /// Room for a chunk's frame and behind it the stored bytes, valid until the next call; empty when
  /// they would not be fewer than `raw` has, when k_max_compression_ratio forbids so few, or when
  /// this build cannot compress.
  [[nodiscard]] std::span<std::byte> compress(ByteView raw);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Replaces `raw`. malformed when the announced size is beyond k_max_compression_ratio, when the
/// bytes give another size or are no Zstandard frame, which is looked at before any memory is
/// taken; unsupported_version in a build without it.
[[nodiscard]] DecodeFault decompress(ByteView stored, std::uint32_t raw_bytes,
                                     std::vector<std::byte>& raw);

}  // namespace lockstone::replay
