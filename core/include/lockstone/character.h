// A character: an upright capsule that a game moves through a world by sweeping and sliding. It is
// no body: bodies stop it, but it moves them only through `apply_pushes`.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/literals.h>
#include <lockstone/query.h>
#include <lockstone/status.h>
#include <lockstone/world.h>

namespace lockstone {

/// Up is +y.
struct CharacterDef {
  Length radius = Length::from_ratio(3, 10);
  Length half_height = Length::from_ratio(6, 10);     ///< of the capsule's core
  Length step_height = Length::from_ratio(35, 100);   ///< ledges up to this are walked onto
  Unit min_ground_slope = Unit::from_ratio(64, 100);  ///< least normal.y to stand on: 50°
  Length skin = Length::from_ratio(1, 100);           ///< gap kept to everything, 1 mm … radius
  Mass mass = Mass::from_integer(80);                 ///< its mass, for pushes
  QueryFilter filter{};  ///< the bodies it collides with; the game can exclude its own
};

/// Something that stopped a character.
struct CharacterHit {
  BodyHandle body{};
  Vec3<Position> point{};
  Vec3<Unit> normal{};  ///< towards the character
  Length blocked{};     ///< how much of the motion against the normal it took away, ≥ 0
};

struct CharacterMove {
  static constexpr std::size_t k_max_hits = 8;

  Vec3<Position> position{};  ///< of the capsule's centre, afterwards
  bool grounded = false;      ///< stands on something walkable
  BodyHandle ground{};        ///< the body it stands on: add its velocity to move with it
  Vec3<Unit> ground_normal{};
  bool stepped = false;  ///< walked up a ledge
  std::array<CharacterHit, k_max_hits> hits{};
  std::size_t hit_count = 0;
};

/// Moves a character from `position` by `motion` (at most 8 m an axis, one tick's motion): out of
/// bodies that it overlaps, along walls, up ledges and walkable slopes, and, when `stay_on_ground`,
/// down to the ground it walks on. It never ends inside anything that it did not start in. The
/// world does not change. Slopes steeper than the definition allows are walls.
///
/// Sweep and slide: P. Fauerby, "Improved collision detection and response", 2003; creases after
/// the character controllers of PhysX and Jolt.
[[nodiscard]] CharacterMove move_character(const World& world, const CharacterDef& character,
                                           const Vec3<Position>& position,
                                           const Vec3<Length>& motion, bool stay_on_ground = true);

/// Pushes the dynamic bodies that stopped a move, each as an inelastic impact of the character's
/// mass at the blocked speed, less the speed that the body already has.
void apply_pushes(World& world, const CharacterDef& character, const CharacterMove& move);

}  // namespace lockstone
