// A character: an upright shape that a game moves through a world by sweeping and sliding. It is no
// body: bodies stop it and carry it, but it moves them only through `apply_pushes`.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <lockstone/literals.h>
#include <lockstone/query.h>
#include <lockstone/status.h>
#include <lockstone/world.h>

namespace lockstone {

struct CharacterDef {
  /// A sphere, capsule, box, cylinder or cone, its centre at the character's position.
  Shape shape = Shape::capsule(Length::from_ratio(6, 10), Length::from_ratio(3, 10));
  /// Of the shape. Its y axis is the character's up: turn it for gravity in another direction, or
  /// about itself for a box that looks another way. A unit.
  Quat orientation{};
  Length step_height = Length::from_ratio(35, 100);   ///< ledges up to this are walked onto
  Unit min_ground_slope = Unit::from_ratio(64, 100);  ///< least cosine between normal and up: 50°
  Length skin = Length::from_ratio(1, 100);  ///< gap kept to everything, 1 mm … inner radius
  Mass mass = Mass::from_integer(80);        ///< for pushes, and its weight
  Vec3<Acceleration> gravity{{}, Acceleration::from_ratio(-981, 100), {}};  ///< for its weight
  Force push_force = Force::from_integer(4000);  ///< the most with which it pushes one body
  QueryFilter filter{};  ///< the bodies it collides with; the game can exclude its own
};

/// Something near that stopped a character, pushed it out of its way, or bears it.
struct CharacterHit {
  BodyHandle body{};
  Vec3<Position> point{};
  Vec3<Unit> normal{};  ///< towards the character
  Length blocked{};     ///< how much of the motion against the normal it took away, ≥ 0
};

struct CharacterMove {
  static constexpr std::size_t k_max_hits = 8;

  Vec3<Position> position{};  ///< of the shape's centre, afterwards
  bool grounded = false;      ///< stands on something walkable
  BodyHandle ground{};        ///< the body it stands on; see `carried_by`
  Vec3<Unit> ground_normal{};
  Vec3<Position> ground_point{};  ///< where it stands on it
  bool stepped = false;           ///< walked up a ledge
  std::array<CharacterHit, k_max_hits> hits{};
  std::size_t hit_count = 0;
};

/// Moves a character from `position` by `motion` (at most 8 m an axis, one tick's motion): out of
/// bodies that it overlaps, along walls, up ledges and walkable slopes, and, when `stay_on_ground`,
/// down to the ground it walks on. `carried` (see `carried_by`) comes on top of its own motion. It
/// never ends inside anything that it did not start in. The world does not change. Slopes steeper
/// than the definition allows are walls.
///
/// Sweep and slide: P. Fauerby, "Improved collision detection and response", 2003; creases after
/// the character controllers of PhysX and Jolt.
[[nodiscard]] CharacterMove move_character(const World& world, const CharacterDef& character,
                                           const Vec3<Position>& position,
                                           const Vec3<Length>& motion, bool stay_on_ground = true,
                                           const Vec3<Length>& carried = {});

/// How the ground carries a character in the coming tick.
struct CharacterCarry {
  Vec3<Length> motion{};  ///< for the next move: at most 8 m an axis
  Quat turn{};            ///< about the character's up
};

/// Nothing where the move did not end on the ground. Of a kinematic body it is exact if its
/// velocities of the coming tick are set.
[[nodiscard]] CharacterCarry carried_by(const World& world, const CharacterDef& character,
                                        const CharacterMove& move);

/// Pushes the dynamic bodies of a move: each one's closing speed at the character, at most the
/// speed of an inelastic impact with the character's mass, and at most by `push_force` over a tick.
/// The ground bears the character's weight, of the world's gravity.
void apply_pushes(World& world, const CharacterDef& character, const CharacterMove& move);

/// Whether a character has room at a position: nothing overlaps it by more than its skin.
[[nodiscard]] bool has_room(const World& world, const CharacterDef& character,
                            const Vec3<Position>& position);

/// The position after a change to another shape, with the foot in place: to crouch, and to stand up
/// again. Nothing where there is no room for it.
[[nodiscard]] std::optional<Vec3<Position>> reshaped(const World& world, const CharacterDef& from,
                                                     const Vec3<Position>& position,
                                                     const CharacterDef& to);

}  // namespace lockstone
