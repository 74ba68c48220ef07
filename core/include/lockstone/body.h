// Bodies: definitions going in, values coming out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <lockstone/collision.h>
#include <lockstone/material.h>
#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Bodies are kept within ±2^20 m of the origin and slower than 500 m/s, in the centre and on the
/// surface. Dynamic ones weigh 1e-6 … 1e9 kg.
inline constexpr Position k_world_limit = Position::from_integer(1 << 20);
inline constexpr Mass k_min_mass = Mass::from_ratio(1, 1'000'000);
inline constexpr Mass k_max_mass = Mass::from_integer(1'000'000'000);
inline constexpr Velocity k_speed_limit = Velocity::from_integer(500);
inline constexpr std::size_t k_max_body_name = 28;  ///< bytes: World::set_name

/// Names a body. A handle whose body was destroyed never names another one. Default: no body.
struct BodyHandle {
  std::uint32_t index = 0;       ///< in the store of bodies
  std::uint32_t generation = 0;  ///< 0 only in the null handle

  friend constexpr auto operator<=>(const BodyHandle&, const BodyHandle&) = default;
  [[nodiscard]] constexpr bool is_null() const { return generation == 0; }
};

enum class MotionType : std::uint8_t {
  static_body = 1,  ///< never moves
  kinematic = 2,    ///< moves as its velocity says, pushed by nothing
  dynamic = 3,      ///< moved by forces, impulses and contacts
};
[[nodiscard]] std::string_view to_string(MotionType motion);

/// World axes that a dynamic body does not move along, or does not turn about, whatever pushes it.
struct AxisLocks {
  bool move_x = false, move_y = false, move_z = false;  ///< along the axis
  bool turn_x = false, turn_y = false, turn_z = false;  ///< about the axis

  friend constexpr bool operator==(const AxisLocks&, const AxisLocks&) = default;
};

/// Limits of a body's speeds at the end of each tick, besides the world's limits.
struct SpeedLimit {
  Velocity linear = k_speed_limit;                                     ///< > 0
  AngularVelocity angular = AngularVelocity::from_integer(1'000'000);  ///< > 0
};

/// Which events a body has. They follow from a tick's result, and change none.
struct EventSettings {
  /// contact_begin and contact_end: a pair has them unless one of the two has none.
  bool contacts = true;
  /// A pair that approaches faster has a HitEvent; of two such speeds the lower counts. 0 … 500
  /// m/s; 0: the body asks for none.
  SolverVelocity hit_speed{};
  /// contact_persist: a pair with contact events has one in every tick in which it goes on
  /// touching, if one of the two asks. A world in which no body asks spends no time on it.
  bool persist = false;

  friend constexpr bool operator==(const EventSettings&, const EventSettings&) = default;
};

/// How much a dynamic body resists a push.
struct MassData {
  Mass mass{};  ///< k_min_mass … k_max_mass; 0: see where it is used
  /// About the centre of mass, along the principal axes of the body's solid: above 0, and at most
  /// mass times s², s m the first power of two not below the body's radius. Less than 2^-12 of
  /// that is raised to it. Zero: the moments of a solid of even density with this mass.
  Vec3<MomentOfInertia> inertia{};

  friend bool operator==(const MassData&, const MassData&) = default;
};

/// A body to be made. Position and orientation place the frame of its shape; velocities are those
/// of the centre of mass, which of sphere, capsule and box is the same point.
struct BodyDef {
  MotionType motion = MotionType::dynamic;
  Shape shape = Shape::sphere(Length::from_ratio(1, 2));
  Vec3<Position> position{};                       ///< within ±2^20 m, and the centre of mass too
  Quat orientation{};                              ///< is normalised
  Vec3<Velocity> velocity{};                       ///< at most 500 m/s
  Vec3<AngularVelocity> angular_velocity{};        ///< rad/s; the surface at most 500 m/s
  Material material{};                             ///< density, friction, …
  MassData mass{};                                 ///< of a dynamic body; mass 0: by density
  SurfaceMotion surface_motion{};                  ///< of static and kinematic bodies
  CollisionFilter filter{};                        ///< which bodies it meets
  Number gravity_scale = Number::from_integer(1);  ///< −100 … 100
  Rate linear_damping{};                           ///< ≥ 0; v' = −c·v; exact in flight
  Rate angular_damping{};                          ///< as linear_damping
  bool is_trigger = false;                         ///< reports overlaps, pushes nothing
  bool fixed_rotation = false;                     ///< never rotates: a character, say
  AxisLocks locks{};                               ///< of a dynamic body
  SpeedLimit speed_limit{};                        ///< at the end of each tick
  bool is_bullet = false;       ///< never passes through dynamic bodies either, at a cost
  bool allow_sleep = true;      ///< may fall asleep; says nothing of a static body
  EventSettings events{};       ///< which events it has
  std::uint64_t user_data = 0;  ///< the game's own; part of the state
};

/// A body as it stands. A copy: it does not change with the world.
struct BodyView {
  MotionType motion{};                       ///< as in BodyDef
  Shape shape{};                             ///< as in BodyDef
  Vec3<Position> position{};                 ///< of the shape's frame
  Quat orientation{};                        ///< of the shape's frame, a unit
  Vec3<Position> centre_of_mass{};           ///< m
  Vec3<Velocity> velocity{};                 ///< of the centre of mass
  Quat principal_axes{};                     ///< in the world: columns of its matrix, a unit
  Vec3<AngularVelocity> angular_velocity{};  ///< rad/s, error ≤ 1e-8 relative
  MassData mass{};                 ///< of a dynamic body, error ≤ 2^-29 relative; else 0
  CollisionFilter filter{};        ///< as in BodyDef
  Surface surface{};               ///< of the body itself
  SurfaceMotion surface_motion{};  ///< as in BodyDef, to 1e-5 m/s
  Number gravity_scale{};          ///< as in BodyDef
  Rate linear_damping{};           ///< as in BodyDef
  Rate angular_damping{};          ///< as in BodyDef
  AxisLocks locks{};               ///< as in BodyDef
  SpeedLimit speed_limit{};        ///< as in BodyDef, within the limits of all bodies
  bool is_trigger = false;         ///< as in BodyDef
  bool is_bullet = false;          ///< as in BodyDef
  bool is_asleep = false;          ///< skipped until it wakes
  bool is_enabled = true;          ///< false: out of the simulation, by SetEnabled
  bool allow_sleep = true;         ///< as in BodyDef
  EventSettings events{};          ///< as in BodyDef
  std::uint64_t user_data = 0;     ///< as in BodyDef
};

}  // namespace lockstone
