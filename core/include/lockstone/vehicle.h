// Vehicles: a dynamic body, the chassis, on sprung wheels that are rays or spheres cast to the
// ground, with tyres, an engine and a gearbox: cars, motorcycles and tracked ones. They are part of
// the state, set and driven by commands.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <lockstone/body.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

class World;

/// The most vehicles of a world, and axles of one.
inline constexpr std::uint32_t k_max_vehicles = 64;
inline constexpr std::uint32_t k_max_axles = 3;
inline constexpr std::uint32_t k_max_gears = 8;
inline constexpr std::size_t k_torque_points = 8;

/// Two wheels, a left one at −z and a right one at +z. In the axes of the chassis' shape x points
/// ahead, y up, z to the right.
struct Axle {
  Vec3<Length> mount{};  ///< between the centres of the wheels where they are highest, ±32 m
  Length half_track = Length::from_ratio(75, 100);  ///< from mount to a wheel, 0 … 16 m
  Length radius = Length::from_ratio(33, 100);      ///< 5 cm … 4 m
  Length travel = Length::from_ratio(25, 100);    ///< way of a wheel down from there, 1 cm … 4 m
  Number frequency = Number::from_ratio(15, 10);  ///< Hz, of the mass on a wheel, 0.2 … 10
  Number damping_ratio = Number::from_ratio(4, 10);  ///< 0 … 2
  Number anti_roll{};                                ///< stiffness over that of a spring, 0 … 4
  Angle max_steer{};                                 ///< ±1.2 rad; the wheels turn about one point
  Unit drive{};                                      ///< share of the drive's torque, 0 … 1
  Torque brake = Torque::from_integer(1500);         ///< of each wheel, 0 … 10^6 N·m
  Torque handbrake{};                                ///< of each wheel
  Torque differential_lock{};  ///< the most from the faster wheel to the other
  Coefficient friction = Coefficient::from_integer(1);  ///< of the tyres, 0 … 1.99

  friend bool operator==(const Axle&, const Axle&) = default;
};

/// Slip at which a tyre grips best. Forces follow curves after H. B. Pacejka, "Tire and Vehicle
/// Dynamics", sin(C·atan(B·slip)), with C = 1.65 along and 1.3 across; both slips together follow
/// the friction circle. They build up over the relaxation length.
struct Tyre {
  Unit peak_slip = Unit::from_ratio(1, 10);       ///< along: slip speed over speed, 0.02 … 1
  Unit peak_angle = Unit::from_ratio(14, 100);    ///< across: tangent of the slip angle, 0.02 … 1
  Length relaxation = Length::from_ratio(3, 10);  ///< 0.1 … 4 m
  Coefficient rolling_resistance = Coefficient::from_ratio(12, 1000);  ///< 0 … 1

  friend bool operator==(const Tyre&, const Tyre&) = default;
};

struct Engine {
  /// At full throttle, at 0, 1/7 … 7/7 of max_speed; between them on straight lines. 0 … 10^6 N·m
  std::array<Torque, k_torque_points> torque{};
  AngularVelocity idle_speed = AngularVelocity::from_integer(90);  ///< rad/s, 1 … max_speed
  AngularVelocity max_speed = AngularVelocity::from_integer(680);  ///< rad/s, to 3000
  MomentOfInertia inertia = MomentOfInertia::from_ratio(2, 10);    ///< 0.01 … 1000 kg·m²
  Torque friction = Torque::from_integer(60);  ///< at max_speed without throttle, 0 … 10^6 N·m

  friend bool operator==(const Engine&, const Engine&) = default;
};

struct Gearbox {
  std::array<Number, k_max_gears> ratios{};  ///< engine over drive shaft, 0 … 100; 0 ends the list
  Number reverse = Number::from_ratio(35, 10);      ///< 0 … 100
  Number final_drive = Number::from_ratio(37, 10);  ///< drive shaft over wheels, 0.1 … 100
  bool automatic = true;                            ///< shifts by itself
  AngularVelocity shift_up = AngularVelocity::from_integer(580);    ///< rad/s of the engine
  AngularVelocity shift_down = AngularVelocity::from_integer(260);  ///< rad/s
  Torque clutch = Torque::from_integer(600);  ///< the most that it transmits, 0 … 10^6 N·m
  std::uint32_t shift_ticks = 12;             ///< in which it is open, 0 … 600

  friend bool operator==(const Gearbox&, const Gearbox&) = default;
};

enum class WheelCast : std::uint8_t {
  ray = 0,     ///< from the wheel's centre down: cheap
  sphere = 1,  ///< of the wheel's radius: rolls over edges
};

[[nodiscard]] std::string_view to_string(WheelCast cast);

enum class VehicleKind : std::uint8_t {
  car = 0,
  motorcycle = 1,  ///< leans into its turns; axles with a half track of 0 have one wheel
  tracked = 2,     ///< the wheels of a side turn together, and their speeds steer
};

[[nodiscard]] std::string_view to_string(VehicleKind kind);

/// The wheels of a tracked vehicle have one radius. Both sides are driven: ahead alike; with the
/// steering halfway to a side its track stands, and at the end it goes back as fast as the other
/// one ahead. `Axle::differential_lock` of the first axle is the most with which the steering gear
/// holds them to that; `drive` of its axles counts for nothing.
struct VehicleDef {
  std::array<Axle, k_max_axles> axles{};  ///< by x, in any order
  std::uint32_t axle_count = 0;           ///< 1 … k_max_axles
  Tyre tyre{};
  Engine engine{};
  Gearbox gearbox{};
  MomentOfInertia wheel_inertia = MomentOfInertia::from_ratio(12, 10);  ///< 0.01 … 1000 kg·m²
  WheelCast cast{};
  std::uint32_t mask = 0xffffffff;  ///< categories of the bodies that carry it
  VehicleKind kind{};
  Angle max_lean = Angle::from_ratio(8, 10);  ///< of a motorcycle, 0 … 1.2 rad

  friend bool operator==(const VehicleDef&, const VehicleDef&) = default;
};

/// The controls of a driver. Each is clamped to its range.
struct VehicleControls {
  Unit throttle{};        ///< 0 … 1
  Unit brake{};           ///< 0 … 1
  Unit handbrake{};       ///< 0 … 1
  Unit steer{};           ///< −1 … 1, to the right
  Unit clutch{};          ///< 0 … 1: pressed; slow engines open it by themselves
  std::int32_t gear = 1;  ///< −1: back; 0: none; else the gear, of an automatic gearbox any

  friend bool operator==(const VehicleControls&, const VehicleControls&) = default;
};

struct WheelView {
  Vec3<Position> centre{};
  AngularVelocity spin{};  ///< about its axis, ahead positive
  Length compression{};    ///< of its spring
  Force load{};            ///< on the ground
  Unit steer_sin{};        ///< of the angle that it is turned to the right
  bool is_grounded = false;
};

struct VehicleView {
  VehicleDef def{};
  VehicleControls controls{};
  std::array<WheelView, 2 * k_max_axles> wheels{};  ///< left and right of each axle
  AngularVelocity engine_speed{};
  std::int32_t gear = 0;
  Angle lean{};  ///< of the chassis to the right, against gravity
};

/// The vehicle of a chassis; nothing where it has none.
[[nodiscard]] std::optional<VehicleView> vehicle_of(const World& world, BodyHandle chassis);

/// An engine of so much power with its best torque at half its greatest speed, five gears, rear
/// wheels driven, front wheels steered: to begin with. `length`: between the axles.
[[nodiscard]] VehicleDef make_car(Length length, Length half_track, Length mount_height,
                                  Torque torque);

/// A motorcycle with a wheel ahead, steered, and one behind, driven.
[[nodiscard]] VehicleDef make_motorcycle(Length length, Length mount_height, Torque torque);

/// A tracked vehicle on three wheels a side, of so much length between the first and the last ones.
[[nodiscard]] VehicleDef make_tank(Length length, Length half_track, Length mount_height,
                                   Torque torque);

}  // namespace lockstone
