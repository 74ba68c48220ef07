// Payloads made smaller with Zstandard, where the library was there when this was built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/bytes.h>

#include "replay/decode_fault.h"

namespace lockstone::replay {

class Compressor {
 public:
  /// Takes all memory that payloads up to `raw_bytes_max` need.
  explicit Compressor(std::size_t raw_bytes_max);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  /// Room for a chunk's frame and behind it the stored bytes, valid until the next call; empty when
  /// they would not be fewer than `raw` has, or when this build cannot compress.
  [[nodiscard]] std::span<std::byte> compress(ByteView raw);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Replaces `raw`. malformed when the bytes give another size than announced or are no Zstandard
/// frame, which is looked at before any memory is taken; unsupported_version in a build without it.
[[nodiscard]] DecodeFault decompress(ByteView stored, std::uint32_t raw_bytes,
                                     std::vector<std::byte>& raw);

}  // namespace lockstone::replay
