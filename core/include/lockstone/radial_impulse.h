// Explosions: the commands that push bodies away from a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <lockstone/command.h>
#include <lockstone/query.h>
#include <lockstone/world.h>

namespace lockstone {

/// How the impulse falls from the centre to the radius.
enum class Falloff : std::uint8_t {
  constant = 0,   ///< not at all
  linear = 1,     ///< 1 − d/r
  quadratic = 2,  ///< (1 − d/r)²
};
[[nodiscard]] std::string_view to_string(Falloff falloff);

/// The most bodies that one radial impulse pushes.
inline constexpr std::size_t k_most_radial_impulses = 1024;

/// The distance d of a body is that of its nearest point; it is pushed at its centre of mass, away
/// from the centre. The impulse is the same for light and heavy bodies, large and small ones.
struct RadialImpulse {
  Vec3<Position> centre{};
  Length radius = Length::from_integer(5);  ///< m, 0 … k_max_cast, above 0
  Impulse impulse{};                        ///< N·s, at the centre; below 0 it pulls
  Falloff falloff = Falloff::linear;
  QueryFilter filter{};             ///< the bodies that may be pushed
  std::uint32_t obstacle_mask = 0;  ///< categories that shield the bodies behind them; 0: none does
};

/// Lists a command for each dynamic body within the radius, by index, as many as `out` holds and at
/// most k_most_radial_impulses; returns how many were written. Reads the world alone: the caller
/// applies the commands, and may change or drop some. A body is behind an obstacle if a ray from
/// the centre to its nearest point meets another body of the mask.
std::size_t radial_impulse(const World& world, const RadialImpulse& def,
                           std::span<ApplyImpulse> out);

}  // namespace lockstone
