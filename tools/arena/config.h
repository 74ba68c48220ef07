// The configuration of a match of the arena: the bytes that every peer starts with.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lockstone/bytes.h>
#include <lockstone/simulation.h>
#include <lockstone/status.h>

namespace lockstone::arena {

/// Changes whenever the same inputs may give another game, for reasons other than the core's.
inline constexpr std::uint32_t k_rules_version = 3;

inline constexpr std::uint32_t k_config_magic = 0x52414b4c;  // "LKAR"
inline constexpr std::uint16_t k_config_version = 1;
inline constexpr std::size_t k_config_bytes = 18;

inline constexpr std::uint16_t k_max_loose_bodies = 600;

/// Which level is built.
enum class Variant : std::uint8_t {
  yard = 0,   ///< hill with two ramps, a sweeping bar, a ferry, a buggy, two goals
  empty = 1,  ///< the same without the hill and the machines
};

struct ArenaConfig {
  std::uint64_t seed = 1;
  std::uint16_t loose_bodies = 216;  ///< crates, balls and barrels, 0 … k_max_loose_bodies
  std::uint8_t players = 4;          ///< 1 … k_max_players
  Variant variant = Variant::yard;

  friend bool operator==(const ArenaConfig&, const ArenaConfig&) = default;

  [[nodiscard]] std::array<std::byte, k_config_bytes> encode() const;

  /// Bytes from outside: truncated, malformed, unsupported_version or invalid_argument.
  static Result<ArenaConfig> decode(ByteView bytes);
};

}  // namespace lockstone::arena
