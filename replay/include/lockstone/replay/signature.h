// Signed logs: checksums find accidents, a signature finds tampering.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <lockstone/replay/source.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// Whether this build makes and checks signatures.
[[nodiscard]] bool signing_available();

/// Ed25519, RFC 8032.
struct PublicKey {
  std::array<std::byte, 32> bytes{};

  friend bool operator==(const PublicKey&, const PublicKey&) = default;

  /// 64 hexadecimal digits.
  [[nodiscard]] std::string to_text() const;
  [[nodiscard]] static Result<PublicKey> from_text(std::string_view text);
};

/// The secret seed of 32 bytes and the public key. To be kept from others.
struct SigningKey {
  std::array<std::byte, 64> bytes{};

  [[nodiscard]] PublicKey public_key() const;

  /// 128 hexadecimal digits.
  [[nodiscard]] std::string to_text() const;
  [[nodiscard]] static Result<SigningKey> from_text(std::string_view text);
};

/// A new key from the system's randomness; incompatible in a build that cannot sign.
[[nodiscard]] Result<SigningKey> make_signing_key();

enum class SignatureState : std::uint8_t {
  none,      ///< the log has no signature
  good,      ///< every signature fits, all by one key, and it is the expected one
  bad,       ///< one does not fit the bytes before it, is malformed, or bytes follow it behind
             ///< the END
  foreign,   ///< by another key than expected, or by several
  unchecked  ///< this build cannot check
};

/// "none", "good", "bad", "foreign", "unchecked".
[[nodiscard]] std::string_view to_string(SignatureState state);

struct SignatureReport {
  SignatureState state = SignatureState::none;
  std::uint32_t signatures = 0;     ///< good ones
  std::uint64_t covered_bytes = 0;  ///< up to the last good one
  std::uint64_t covered_ticks = 0;  ///< the log's position there, less its start tick
  bool covers_end = false;          ///< the END is covered and nothing follows: it is the whole log
  PublicKey key;                    ///< whose they are; to be trusted only when it was expected
};

/// Reads a whole log and checks its signatures. Without `expected`, any one key will do: that tells
/// only that one person wrote it all.
[[nodiscard]] SignatureReport check_signatures(Source& source,
                                               const std::optional<PublicKey>& expected = {});

}  // namespace lockstone::replay
