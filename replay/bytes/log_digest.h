// The digest that a signature signs: of every byte of a log before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/replay/signature.h>

namespace lockstone::replay {

/// Payload of a SIGNATURE: offset of the chunk, public key, signature.
inline constexpr std::size_t k_signature_bytes = 8 + 32 + 64;

/// BLAKE2b over bytes as they come. The constructor allocates; nothing after it does.
class LogDigest {
 public:
  LogDigest();
  ~LogDigest();
  LogDigest(const LogDigest&) = delete;
  LogDigest& operator=(const LogDigest&) = delete;

  void update(ByteView bytes);

  /// Signs the bytes so far.
  void sign(const SigningKey& key, std::span<std::byte, k_signature_bytes> payload) const;

  /// Whether `payload` is a signature over the bytes so far, by the key that it names.
  [[nodiscard]] bool check(std::span<const std::byte, k_signature_bytes> payload) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lockstone::replay
