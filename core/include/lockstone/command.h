// Commands: the only way to write a world. Each is a plain value; the manifest below names them all
// and drives dispatch, so that a command cannot be half added.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include <lockstone/body.h>
#include <lockstone/fluid.h>
#include <lockstone/joint.h>
#include <lockstone/rules.h>
#include <lockstone/terrain.h>
#include <lockstone/vehicle.h>

namespace lockstone {

/// The frame of the vectors and points of a command.
enum class Frame : std::uint8_t {
  world = 0,  ///< world axes, points relative to the centre of mass
  body = 1,   ///< the frame of the body's shape
};
[[nodiscard]] std::string_view to_string(Frame frame);
/// Makes a body: see `World::create_body`.
struct CreateBody {
  BodyDef def{};
};
struct DestroyBody {
  BodyHandle body{};
};

/// Moves a body at once; its contacts end. Orientation is normalised.
struct Teleport {
  BodyHandle body{};
  Vec3<Position> position{};  ///< m, within ±2^20: of the shape's frame
  Quat orientation{};         ///< of the shape's frame; any length but 0
};
/// Sets the velocity of the centre of mass: at most 500 m/s.
struct SetVelocity {
  BodyHandle body{};
  Vec3<Velocity> velocity{};  ///< m/s
};
struct SetAngularVelocity {
  BodyHandle body{};
  Vec3<AngularVelocity> angular_velocity{};  ///< rad/s
};

/// At the centre of mass. Impulses leave velocity, and angular momentum over mass and size, within
/// ±500 m/s an axis: they are clamped there.
struct ApplyImpulse {
  BodyHandle body{};
  Vec3<Impulse> impulse{};  ///< N·s
  Frame frame{};            ///< of the vectors
};

/// At a point within twice the body's radius of its centre of mass.
struct ApplyImpulseAt {
  BodyHandle body{};
  Vec3<Impulse> impulse{};  ///< N·s
  Vec3<Length> point{};     ///< m
  Frame frame{};            ///< of the vectors
};
/// Changes the angular momentum at once; clamped as by `ApplyImpulse`.
struct ApplyAngularImpulse {
  BodyHandle body{};
  Vec3<AngularImpulse> impulse{};  ///< N·m·s
  Frame frame{};                   ///< of the vectors
};

/// At the centre of mass. A force works evenly over the coming tick and is then gone, a torque too;
/// those of a tick add up, each axis to at most ±1000 m/s.
struct ApplyForce {
  BodyHandle body{};
  Vec3<Force> force{};  ///< N
  Frame frame{};        ///< of the vectors
};

/// At a point as that of an impulse. Both turn with the body in the tick no more than the world
/// does.
struct ApplyForceAt {
  BodyHandle body{};
  Vec3<Force> force{};   ///< N
  Vec3<Length> point{};  ///< m
  Frame frame{};         ///< of the vectors
};
/// Works evenly over the coming tick and is then gone, as `ApplyForce`.
struct ApplyTorque {
  BodyHandle body{};
  Vec3<Torque> torque{};  ///< N·m
  Frame frame{};          ///< of the vectors
};

/// Gives a kinematic body the velocities that take it to a pose in one tick. It keeps them until it
/// is told otherwise. invalid_argument where they exceed the speed limit.
struct MoveKinematic {
  BodyHandle body{};
  Vec3<Position> position{};  ///< m, within ±2^20: of the shape's frame
  Quat orientation{};         ///< of the shape's frame; any length but 0
};

/// Of the body itself; parts of assets keep theirs.
struct SetMaterial {
  BodyHandle body{};
  Surface surface{};
};

/// Of a body that is not dynamic.
struct SetSurfaceMotion {
  BodyHandle body{};
  SurfaceMotion motion{};
};
struct SetGravityScale {
  BodyHandle body{};
  Number scale{};  ///< factor of gravity, −100 … 100
};
struct SetDamping {
  BodyHandle body{};
  Rate linear{};   ///< 1/s, ≥ 0
  Rate angular{};  ///< 1/s, ≥ 0
};

/// Stops the body along and about the axes that are locked. Contacts keep their impulses. Refused
/// where a joint sits too far away for a body that turns.
struct SetAxisLocks {
  BodyHandle body{};
  AxisLocks locks{};
};
struct SetSpeedLimit {
  BodyHandle body{};
  SpeedLimit limit{};
};
struct SetFilter {
  BodyHandle body{};
  CollisionFilter filter{};
};
struct SetUserData {
  BodyHandle body{};
  std::uint64_t user_data = 0;
};
/// Changes no motion, and wakes nothing.
struct SetEvents {
  BodyHandle body{};
  EventSettings settings{};
};

/// Makes a body static, kinematic or dynamic. Its place, velocities and joints stay, but a static
/// body has no velocity, and its contacts end. invalid_argument for a body without volume that
/// would move, and where a joint would be left without a dynamic body.
struct SetMotionType {
  BodyHandle body{};
  MotionType motion{};
  Mass mass{};  ///< of a body that becomes dynamic; 0: of its solid at 1000 kg/m³
};

/// Gives a body another shape in the same frame: the material points of the body keep their places
/// and velocities, and joints their anchors. Contacts that no longer hold end in the next step.
/// not_found for an unknown asset; invalid_argument for a shape without volume on a body that
/// moves, and where a joint would sit too far from the new centre of mass.
struct SetShape {
  BodyHandle body{};
  Shape shape{};
  Mass mass{};  ///< of a dynamic body; 0: it keeps its own. Moments are those of the solid
};

/// Of a dynamic body; mass 0: it keeps its own. Velocities stay.
struct SetMassData {
  BodyHandle body{};
  MassData data{};
};

/// A disabled body stays as it is, velocities included, until it is enabled: nothing meets or finds
/// it, it does not move, and its joints do nothing. Its contacts end, and it cannot be pushed by a
/// force or put to sleep.
struct SetEnabled {
  BodyHandle body{};
  bool enabled = true;
};
/// Wakes a dynamic or kinematic body, and the island that it sleeps in. Commands that push, move or
/// change a body do so by themselves.
struct WakeBody {
  BodyHandle body{};
};

/// Puts the island of a dynamic body to sleep as it stands; velocities are lost. invalid_argument
/// when the world or a body of the island never sleeps. A body in contact with an awake body of
/// another kind wakes again in the next step.
struct SleepBody {
  BodyHandle body{};
};

/// A body that is not allowed to sleep wakes, and keeps its island awake.
struct SetAllowSleep {
  BodyHandle body{};
  bool allow = true;
};
/// Makes a joint: see `World::create_joint`.
struct CreateJoint {
  JointDef def{};
};
struct DestroyJoint {
  JointHandle joint{};
};

/// New settings for one axis, limits and drive alike: axis 0 … 2.
struct SetLinearAxis {
  JointHandle joint{};
  std::uint8_t axis = 0;  ///< 0 … 2: x, y, z of frame a
  LinearAxis settings{};
};
struct SetAngularAxis {
  JointHandle joint{};
  std::uint8_t axis = 0;  ///< 0 … 2: x, y, z of frame a
  AngularAxis settings{};
};
/// Of the world, from the next step on. A change wakes every body.
struct SetGravity {
  Vec3<Acceleration> gravity{};  ///< m/s²
};

/// Sets or changes a fluid, or with density 0 removes it. Wakes the bodies in the fluid as it was
/// and as it is.
struct SetFluid {
  std::uint32_t number = 0;  ///< below k_max_fluids
  Fluid fluid{};
};

/// How two bodies treat each other, until one of them is destroyed; the default rule removes
/// theirs. Wakes both. capacity_exhausted beyond k_max_pair_rules.
struct SetPairRule {
  BodyHandle a{};
  BodyHandle b{};
  PairRule rule{};
};

/// The surface of all contacts between surfaces with these tags, in either order; without a value
/// they combine again. Wakes every body. capacity_exhausted beyond k_max_surface_rules.
struct SetSurfaceRule {
  std::uint32_t tag_a = 0;
  std::uint32_t tag_b = 0;
  std::optional<PairSurface> surface{};
};

/// Lets a static or kinematic body stop others from one side only. `SetMotionType` to or from
/// dynamic ends it.
struct SetOneWay {
  BodyHandle body{};
  OneWay one_way{};
};

/// Makes a dynamic body the chassis of a vehicle that stands still, or without a definition takes
/// its wheels away. capacity_exhausted beyond WorldDef::vehicle_capacity.
struct SetVehicle {
  BodyHandle chassis{};
  std::optional<VehicleDef> def{};
};

/// Until the next one. invalid_argument for a body that is no chassis.
struct DriveVehicle {
  BodyHandle chassis{};
  VehicleControls controls{};
};

/// Changes `columns` × `rows` samples of the height field of a static body, from sample (column,
/// row) on, and the (columns − 1) · (rows − 1) cells between them, all row by row. An empty list
/// leaves its part as it is. The lists are read before `World::apply` returns. Wakes the bodies on
/// these cells. not_found for a body without a height field; invalid_argument for a rectangle
/// beyond the grid or lists of other sizes; capacity_exhausted beyond
/// WorldDef::terrain_tile_capacity.
struct SetHeights {
  BodyHandle body{};
  std::uint32_t column = 0;
  std::uint32_t row = 0;
  std::uint32_t columns = 1;
  std::uint32_t rows = 1;
  std::span<const Length> heights{};              ///< m, y in the frame of the asset, ±512 m
  std::span<const std::uint8_t> holes{};          ///< not 0 where there is a hole
  std::span<const std::uint8_t> cell_surfaces{};  ///< as of HeightFieldDef; without effect in holes
};

/// Switches a group of triangles of a body's mesh on or off: nothing meets the triangles of a group
/// that is off. Wakes the bodies there. not_found for a body without a mesh of groups;
/// invalid_argument for a group without triangles; capacity_exhausted beyond
/// WorldDef::terrain_tile_capacity.
struct SetMeshGroup {
  BodyHandle body{};
  std::uint32_t group = 0;
  bool is_on = true;
};

// clang-format off
#define LKS_COMMANDS(X) \
  X(CreateBody) X(DestroyBody) X(Teleport) X(SetVelocity) X(SetAngularVelocity) \
  X(ApplyImpulse) X(ApplyImpulseAt) X(ApplyAngularImpulse) X(ApplyForce) X(ApplyForceAt) X(ApplyTorque) \
  X(MoveKinematic) X(SetMaterial) X(SetSurfaceMotion) X(SetGravityScale) X(SetDamping) X(SetAxisLocks) \
  X(SetSpeedLimit) X(SetFilter) X(SetUserData) \
  X(WakeBody) X(SleepBody) X(SetAllowSleep) X(SetGravity) \
  X(CreateJoint) X(DestroyJoint) X(SetLinearAxis) X(SetAngularAxis) \
  X(SetEvents) \
  X(SetMotionType) X(SetShape) X(SetMassData) X(SetEnabled) \
  X(SetFluid) X(SetPairRule) X(SetSurfaceRule) X(SetOneWay) \
  X(SetVehicle) X(DriveVehicle) X(SetHeights) X(SetMeshGroup)
// clang-format on

#define LKS_COMMAND_ALTERNATIVE(Name) , Name
using Command = std::variant<std::monostate LKS_COMMANDS(LKS_COMMAND_ALTERNATIVE)>;
#undef LKS_COMMAND_ALTERNATIVE

/// "CreateBody", …; "no command" of one that holds none.
[[nodiscard]] std::string_view name_of(const Command& command);

}  // namespace lockstone
