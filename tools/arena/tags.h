// The game's tag in a body's user data: its kind, its number and the player that touched it last.
#pragma once

#include <cstdint>
#include <string>

#include <lockstone/world.h>

namespace lockstone::arena {

enum class Kind : std::uint8_t {
  scenery = 0,
  player = 1,
  crate = 2,
  ball = 3,
  barrel = 4,
  snowball = 5,
  goal = 6,
  hill = 7,
  ferry = 8,
  bar = 9,
  buggy = 10,
};

/// Collision categories.
enum Category : std::uint32_t {
  k_scenery_bit = 1,
  k_player_bit = 2,
  k_loose_bit = 4,
  k_shot_bit = 8,
  k_zone_bit = 16,
  k_buggy_bit = 32,
};

struct Tag {
  Kind kind = Kind::scenery;
  std::uint16_t number = 0;
  std::uint8_t owner = 0;  ///< slot + 1 of the player who touched it last, or 0

  [[nodiscard]] constexpr std::uint64_t pack() const {
    return static_cast<std::uint64_t>(kind) | std::uint64_t{number} << 8 |
           std::uint64_t{owner} << 24;
  }
  [[nodiscard]] static constexpr Tag unpack(std::uint64_t bits) {
    return {static_cast<Kind>(bits & 0xff), static_cast<std::uint16_t>(bits >> 8 & 0xffff),
            static_cast<std::uint8_t>(bits >> 24 & 0xff)};
  }
  /// Crates, balls and barrels: objects that can be carried into a goal.
  [[nodiscard]] constexpr bool is_loose() const {
    return kind >= Kind::crate && kind <= Kind::barrel;
  }
  /// "crate 17"
  [[nodiscard]] std::string name() const;
};

/// The body must exist.
[[nodiscard]] inline Tag tag_of(const World& world, BodyHandle body) {
  return Tag::unpack(world.body(body).user_data);
}

}  // namespace lockstone::arena
