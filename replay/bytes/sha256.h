// SHA-256, so that a transcript is the same in every build, with or without libsodium.
// Source: NIST FIPS 180-4, "Secure Hash Standard", sections 4.1.2, 5.3.3 and 6.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lockstone/bytes.h>

namespace lockstone::replay {

/// Bytes as they come. Never allocates.
class Sha256 {
 public:
  void update(ByteView bytes);

  /// Of all bytes so far; more may follow.
  [[nodiscard]] std::array<std::byte, 32> value() const;

 private:
  static constexpr std::size_t k_block_bytes = 64;

  void put(std::byte byte);
  void compress();

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, k_block_bytes> block_{};
  std::uint64_t bytes_ = 0;
};

}  // namespace lockstone::replay
