// Keys of encrypted sessions, and where randomness for them comes from.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include <lockstone/status.h>

namespace lockstone::net {

inline constexpr std::size_t k_key_bytes = 32;
inline constexpr std::size_t k_link_key_bytes = 16;

/// A secret of 256 bits.
struct Key {
  std::array<std::byte, k_key_bytes> bytes{};
  friend bool operator==(const Key&, const Key&) = default;

  /// 64 lower-case hexadecimal digits.
  [[nodiscard]] std::string to_text() const;
  /// malformed: anything else than 64 hexadecimal digits.
  [[nodiscard]] static Result<Key> from_text(std::string_view text);
};

/// A secret that all peers of a match know: it keeps strangers' datagrams out, and proves no
/// identity.
struct LinkKey {
  std::array<std::byte, k_link_key_bytes> bytes{};
  friend bool operator==(const LinkKey&, const LinkKey&) = default;
};

/// Secrets that only the two ends of one connection know: the keys of the datagrams in either
/// direction.
struct DatagramKeys {
  LinkKey send;
  LinkKey receive;
};

/// Where secrets and nonces are drawn from. Anything but SystemRandom is for tests.
class RandomSource {
 public:
  virtual ~RandomSource() = default;
  virtual void fill(std::span<std::byte> out) = 0;
};

/// The operating system's generator. Only where security_available.
class SystemRandom final : public RandomSource {
 public:
  void fill(std::span<std::byte> out) override;
};

/// False in a build without libsodium: tokens, encryption and link keys then return `incompatible`.
[[nodiscard]] bool security_available();

[[nodiscard]] Key make_key(RandomSource& random);

}  // namespace lockstone::net
