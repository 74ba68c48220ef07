// Small helpers to build scenes with.
#pragma once

#include <lockstone/literals.h>
#include <lockstone/world.h>

#include "tools/arena/integers.h"
#include "tools/scenes/scene.h"

namespace lockstone::scenes {

using arena::millimetres;
using arena::millimetres_long;
using arena::mix;
using arena::Random;

inline constexpr Vec3<Unit> k_x_axis{Unit::from_integer(1), {}, {}};
inline constexpr Vec3<Unit> k_y_axis{{}, Unit::from_integer(1), {}};
inline constexpr Vec3<Unit> k_z_axis{{}, {}, Unit::from_integer(1)};

/// The world of most scenes: small, default rules.
[[nodiscard]] WorldDef small_world();

/// A scene's definition fits its world.
BodyHandle add(World& world, const BodyDef& def);

/// A command that a scene knows to be valid.
void order(World& world, const Command& command);

[[nodiscard]] BodyDef fixed_box(const Vec3<Position>& position, const Vec3<Length>& half_extents);
[[nodiscard]] BodyDef loose(const Shape& shape, const Vec3<Position>& position);

/// A static body of any shape.
[[nodiscard]] BodyDef fixed(const Shape& shape, const Vec3<Position>& position);

/// For `Scene::observe`: a trigger counts in its user data, entries in the low half, exits in the
/// high half.
void count_in_triggers(World& world);

/// A static box whose top is the plane y = 0, half as wide as given.
void add_ground(World& world, Length half_width);

/// `count` boxes of 1 m on top of each other, the lowest on y = 0.
void add_stack(World& world, const Vec3<Position>& base, int count);

/// Torso and head, two arms and two legs of two parts each: 10 bodies, 9 joints.
void add_ragdoll(World& world, const Vec3<Position>& at, std::uint64_t user_data = 0);

/// A sphere, capsule or box of random size.
[[nodiscard]] Shape random_shape(Random& random);
[[nodiscard]] Quat random_orientation(Random& random);

// The scenes, by topic.
extern const Scene k_stack, k_pyramid, k_wall, k_far, k_pile;            // piles.cpp
extern const Scene k_rolling, k_capsule, k_bounce, k_friction, k_spin;   // motions.cpp
extern const Scene k_kinematic, k_trigger, k_spawn;                      // driven.cpp
extern const Scene k_commands;                                           // all_commands.cpp
extern const Scene k_hulls, k_compounds;                                 // convex.cpp
extern const Scene k_terrain, k_mesh;                                    // surfaces.cpp
extern const Scene k_rollers, k_drums, k_cones, k_coins, k_clubs;        // rims.cpp
extern const Scene k_dice, k_pebbles;                                    // rounded.cpp
extern const Scene k_bullets;                                            // bullets.cpp
extern const Scene k_layers;                                             // layers.cpp
extern const Scene k_level;                                              // level.cpp
extern const Scene k_belts;                                              // belts.cpp
extern const Scene k_crowd, k_characters;                                // crowd.cpp
extern const Scene k_arch, k_cards, k_shaken_wall;                       // masonry.cpp
extern const Scene k_boats;                                              // water.cpp
extern const Scene k_explosion;                                          // blast.cpp
extern const Scene k_one_way;                                            // one_way.cpp
extern const Scene k_terrain_edit;                                       // terrain_edit.cpp
extern const Scene k_race;                                               // race.cpp
extern const Scene k_motorcycle, k_tank;                                 // riders.cpp
extern const Scene k_ragdoll_drive;                                      // ragdolls.cpp
extern const Scene k_trapdoors;                                          // trapdoors.cpp
extern const Scene k_moving_deck;                                        // deck.cpp
extern const Scene k_coaster, k_ratchets;                                // rails.cpp
extern const Scene k_sleep;                                              // sleep.cpp
extern const Scene k_chain, k_pendulum, k_bridge, k_ragdoll, k_vehicle;  // joints.cpp
extern const Scene k_net;                                                // joints.cpp

}  // namespace lockstone::scenes
