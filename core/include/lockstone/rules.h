// Rules about pairs: data in place of callbacks. They are part of the state, set by commands.
#pragma once

#include <cstdint>
#include <optional>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

struct BodyHandle;
class World;

/// The most rules of each kind in a world.
inline constexpr std::uint32_t k_max_pair_rules = 255;
inline constexpr std::uint32_t k_max_surface_rules = 128;

/// The surface of a contact, in place of the one that combines both sides.
struct PairSurface {
  Coefficient friction{};            ///< 0 … 1.99
  Coefficient restitution{};         ///< 0 … 1
  Coefficient rolling_resistance{};  ///< 0 … 1

  friend constexpr bool operator==(const PairSurface&, const PairSurface&) = default;
};

/// How two bodies treat each other.
struct PairRule {
  bool collides = true;                  ///< false: they never meet, and no trigger sees the other
  std::optional<PairSurface> surface{};  ///< of their contacts, before every other surface

  friend constexpr bool operator==(const PairRule&, const PairRule&) = default;
};

/// A body that stops others from one side only: a platform that one can jump onto from below.
struct OneWay {
  /// Points out of the front, in the axes of the body's shape; any length. Kept to a third of a
  /// degree. Zero: the body stops others from every side.
  Vec3<Unit> direction{};
  /// Degrees, 1 … 90: a contact holds while its normal is at most as far from the direction.
  std::uint8_t tolerance = 60;

  friend constexpr bool operator==(const OneWay&, const OneWay&) = default;
};

/// The rule of two bodies; the default where none was set.
[[nodiscard]] PairRule pair_rule_of(const World& world, BodyHandle a, BodyHandle b);

/// The surface of two tags; nothing where none was set.
[[nodiscard]] std::optional<PairSurface> surface_rule_of(const World& world, std::uint32_t tag_a,
                                                         std::uint32_t tag_b);

/// As it is kept. The body must exist.
[[nodiscard]] OneWay one_way_of(const World& world, BodyHandle body);

}  // namespace lockstone
