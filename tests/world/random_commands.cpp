#include "tests/world/random_commands.h"

#include <array>
#include <span>

#include <gtest/gtest.h>

#include "tests/support/sample_assets.h"
#include "tests/world/world_fixture.h"

namespace lockstone::test {

using namespace literals;

namespace {

// Of the least number, which has no magnitude, the least number.
template <class Quantity>
Quantity size_of(Quantity x) {
  return x == Quantity::min() ? x : abs(x);
}

}  // namespace

template <class Quantity>
Quantity CommandDice::number(Quantity reach) {
  using Raw = typename Quantity::Representation;
  if (!goes_wild())
    return Quantity::from_raw(static_cast<Raw>(random_.between(-reach.raw, reach.raw)));
  const Raw ends[] = {Quantity::max().raw,
                      Quantity::min().raw,
                      Raw(Quantity::min().raw + 1),
                      Raw(reach.raw + 1),
                      Raw(-reach.raw - 1),
                      Raw(-1),
                      Raw(0),
                      static_cast<Raw>(random_.next())};
  return Quantity::from_raw(ends[random_.below(8)]);
}

BodyHandle CommandDice::body() {
  if (goes_wild()) {
    const BodyHandle strange[] = {
        {}, {0, 0xffffffff}, {0xffffffff, 1}, {world_.body_limit(), 1}, {1, 99}, {2, 0}};
    return strange[random_.below(6)];
  }
  return world_.body_at(static_cast<std::uint32_t>(random_.below(world_.body_limit() + 1)));
}

JointHandle CommandDice::joint() {
  if (goes_wild()) {
    const JointHandle strange[] = {{}, {0, 0xffffffff}, {0xffffffff, 1}, {1, 99}};
    return strange[random_.below(4)];
  }
  return world_.joint_at(static_cast<std::uint32_t>(random_.below(world_.joint_limit() + 1)));
}

Quat CommandDice::turn() {
  const Unit one = Unit::from_integer(1);
  if (chance(3)) return {};
  return {number(one), number(one), number(one), number(one)};
}

Frame CommandDice::frame() {
  return static_cast<Frame>(random_.below(goes_wild() ? 256 : 2));
}

std::uint8_t CommandDice::axis() {
  return static_cast<std::uint8_t>(random_.below(goes_wild() ? 256 : 3));
}

Surface CommandDice::surface() {
  Surface surface;
  surface.friction = size_of(number(Coefficient(1_r))),
  surface.restitution = size_of(number(Coefficient(1_r)));
  if (goes_wild()) surface.rolling_resistance = number(Coefficient(1_r));
  surface.friction_rule = static_cast<CombineRule>(random_.below(goes_wild() ? 256 : 6));
  surface.tag = static_cast<std::uint32_t>(random_.below(4));
  return surface;
}

PairSurface CommandDice::pair_surface() {
  const Coefficient friction = size_of(number(Coefficient(1_r)));
  return {friction, size_of(number(Coefficient(1_r))), {}};
}

EventSettings CommandDice::events() {
  EventSettings settings{!chance(4), {}};
  if (chance(2)) settings.hit_speed = size_of(number(SolverVelocity::from_integer(2)));
  settings.persist = settings.hit_speed.raw % 2 != 0;  // draws no number of its own
  return settings;
}

BodyDef CommandDice::body_def() {
  constexpr MotionType k_motions[] = {MotionType::dynamic, MotionType::dynamic,
                                      MotionType::kinematic, MotionType::static_body};
  BodyDef def;
  def.motion =
      goes_wild() ? static_cast<MotionType>(random_.below(256)) : k_motions[random_.below(4)];
  def.shape = chance(2) ? Shape::box(0.3_m, 0.3_m, 0.3_m) : Shape::capsule(0.3_m, 0.2_m);
  constexpr std::uint32_t k_shape_kinds = static_cast<std::uint32_t>(k_last_shape_kind) + 1;
  if (goes_wild())  // one kind that does not exist among them
    def.shape = {static_cast<ShapeKind>(random_.below(k_shape_kinds + 1)), vector(Length(1_m)), {}};
  def.position = vector(Position(3_m));
  def.position.y.raw = raw::saturating_add(def.position.y.raw, Position(2_m).raw);
  def.orientation = turn();
  if (def.motion != MotionType::static_body && chance(2)) def.velocity = vector(Velocity(3_mps));
  if (goes_wild()) def.gravity_scale = number(Number::from_integer(100));
  if (goes_wild()) def.linear_damping = number(Rate::from_integer(3));
  if (goes_wild()) def.material.density = number(Density::from_integer(1000));
  def.is_trigger = chance(8);
  def.is_bullet = chance(8);
  def.fixed_rotation = chance(8);
  def.allow_sleep = !chance(8);
  def.events = events();
  return def;
}

template <class Axis>
void CommandDice::fill_axis(Axis& axis) {
  axis.mode = static_cast<AxisMode>(random_.below(goes_wild() ? 256 : 3));
  axis.lower = number(decltype(axis.lower)::from_ratio(1, 4));
  if (axis.lower.raw > 0) axis.lower = -axis.lower;
  axis.upper = size_of(number(decltype(axis.upper)::from_ratio(1, 4)));
  if (chance(2)) axis.hertz = Number::from_integer(random_.between(0, 10));
  if (goes_wild()) axis.hertz = number(Number::from_integer(1000));
  axis.target = number(decltype(axis.target)::from_ratio(1, 4));
  axis.speed = number(decltype(axis.speed)::from_integer(2));
  if (chance(2)) axis.max_effort = number(decltype(axis.max_effort)::from_integer(1000));
}

void CommandDice::fill(CreateBody& c) {
  c.def = body_def();
}
void CommandDice::fill(DestroyBody& c) {
  c.body = body();
}
void CommandDice::fill(Teleport& c) {
  c = {body(), vector(Position(3_m)), turn()};
}
void CommandDice::fill(SetVelocity& c) {
  c = {body(), vector(wild_ ? k_speed_limit : Velocity(3_mps))};
}
void CommandDice::fill(SetAngularVelocity& c) {
  c = {body(), vector(AngularVelocity(9_rps))};
}
void CommandDice::fill(ApplyImpulse& c) {
  c = {body(), vector(Impulse(900_Ns)), frame()};
}
void CommandDice::fill(ApplyImpulseAt& c) {
  c = {body(), vector(Impulse(900_Ns)), vector(Length(0.3_m)), frame()};
}
void CommandDice::fill(ApplyAngularImpulse& c) {
  c = {body(), vector(AngularImpulse::from_integer(90)), frame()};
}
void CommandDice::fill(ApplyForce& c) {
  c = {body(), vector(Force(9000_N)), frame()};
}
void CommandDice::fill(ApplyForceAt& c) {
  c = {body(), vector(Force(9000_N)), vector(Length(0.3_m)), frame()};
}
void CommandDice::fill(ApplyTorque& c) {
  c = {body(), vector(Torque::from_integer(900)), frame()};
}
void CommandDice::fill(MoveKinematic& c) {
  c.body = body();
  c.position =
      c.body.is_null() || !world_.exists(c.body) ? Vec3<Position>{} : world_.position(c.body);
  c.position.x.raw = raw::saturating_add(c.position.x.raw, number(Position::from_ratio(1, 20)).raw);
  c.orientation = turn();
}
void CommandDice::fill(SetMaterial& c) {
  c = {body(), surface()};
}
void CommandDice::fill(SetSurfaceMotion& c) {
  c = {body(), {vector(SolverVelocity::from_integer(2)), vector(Rate::from_integer(2))}};
}
void CommandDice::fill(SetGravityScale& c) {
  c = {body(), number(Number::from_integer(2))};
}
void CommandDice::fill(SetDamping& c) {
  c = {body(), Rate::from_integer(random_.between(0, 5)), Rate{}};
  if (goes_wild()) c.angular = number(Rate::from_integer(5));
}
void CommandDice::fill(SetAxisLocks& c) {
  c = {body(), {chance(4), chance(4), chance(4), chance(4), chance(4), chance(4)}};
}
void CommandDice::fill(SetSpeedLimit& c) {
  c = {body(), {Velocity::from_integer(random_.between(1, 400)), AngularVelocity(100_rps)}};
  if (goes_wild()) c.limit.angular = number(AngularVelocity(100_rps));
}
void CommandDice::fill(SetFilter& c) {
  c = {body(), {1, chance(4) ? 0 : 0xffffffff, static_cast<std::int32_t>(random_.below(2))}};
}
void CommandDice::fill(SetUserData& c) {
  c = {body(), random_.next()};
}
void CommandDice::fill(SetEvents& c) {
  c = {body(), events()};
}
void CommandDice::fill(SetMotionType& c) {
  c = {
      body(), static_cast<MotionType>(goes_wild() ? random_.below(256) : 1 + random_.below(3)), {}};
  if (chance(2)) c.mass = number(Mass::from_integer(100));
}
void CommandDice::fill(SetShape& c) {
  c.body = body();
  c.shape = body_def().shape;
  if (chance(2)) c.mass = size_of(number(Mass::from_integer(100)));
}
void CommandDice::fill(SetMassData& c) {
  c.body = body();
  if (chance(2)) c.data.mass = size_of(number(Mass::from_integer(100)));
  if (chance(2)) return;
  for (int i = 0; i < 3; ++i)
    c.data.inertia[i] = size_of(number(MomentOfInertia::from_integer(3)));
}
void CommandDice::fill(SetEnabled& c) {
  c = {body(), !chance(3)};
}
void CommandDice::fill(SetFluid& c) {
  c.number = static_cast<std::uint32_t>(random_.below(goes_wild() ? 2 * k_max_fluids : 2));
  c.fluid.surface = vector(Position(1_m));
  c.fluid.size = {size_of(number(Position(4_m))), size_of(number(Position(4_m))), 3_m};
  if (goes_wild()) c.fluid.orientation = turn();
  if (!chance(3)) c.fluid.density = size_of(number(Density::from_integer(2000)));
  c.fluid.drag = size_of(number(Number::from_integer(2)));
  c.fluid.linear_drag = size_of(number(Rate::from_integer(2)));
  c.fluid.flow = vector(Velocity(3_mps));
}
void CommandDice::fill(SetPairRule& c) {
  c.a = body();
  c.b = body();
  c.rule.collides = chance(2);
  if (chance(2)) c.rule.surface = pair_surface();
}
void CommandDice::fill(SetSurfaceRule& c) {
  c.tag_a = static_cast<std::uint32_t>(random_.below(3));
  c.tag_b = static_cast<std::uint32_t>(random_.below(3));
  if (!chance(3)) c.surface = pair_surface();
}
void CommandDice::fill(SetOneWay& c) {
  c.body = body();
  if (!chance(3)) c.one_way.direction = {number(Unit(1_r)), Unit(1_r), {}};
  c.one_way.tolerance = static_cast<std::uint8_t>(random_.below(goes_wild() ? 256 : 91));
}
void CommandDice::fill(SetVehicle& c) {
  c.chassis = body();
  if (chance(4)) return;
  c.def = make_car(2.4_m, 0.7_m, {}, Torque::from_integer(300));
  if (chance(3)) c.def = make_motorcycle(1.5_m, {}, Torque::from_integer(60));
  if (chance(3)) c.def = make_tank(3_m, 1_m, {}, Torque::from_integer(900));
  if (goes_wild()) c.def->max_lean = number(Angle(1.2_rad));
  if (goes_wild()) c.def->kind = static_cast<VehicleKind>(random_.below(5));
  if (goes_wild()) c.def->axle_count = static_cast<std::uint32_t>(random_.below(5));
  if (goes_wild()) c.def->axles[0].radius = number(Length(1_m));
  if (goes_wild()) c.def->engine.max_speed = number(AngularVelocity::from_integer(9000));
}
void CommandDice::fill(DriveVehicle& c) {
  c.chassis = body();
  const Unit one = Unit::from_integer(1);
  c.controls = {number(one), number(one), number(one), number(one), number(one), 1};
  if (chance(3)) c.controls.gear = static_cast<std::int32_t>(random_.between(-2, 9));
}
void CommandDice::fill(SetHeights& c) {
  static constexpr std::array<Length, 4> k_heights{Length::from_integer(1)};
  c.body = chance(2) ? body() : world_.body_at(13);  // the terrain of a crowd
  c.column = static_cast<std::uint32_t>(random_.below(3));
  if (goes_wild()) c.columns = static_cast<std::uint32_t>(random_.below(4));
  c.heights = std::span(k_heights).subspan(random_.below(2), 1);
}
void CommandDice::fill(SetMeshGroup& c) {
  c.body = chance(2) ? body() : world_.body_at(14);  // the panels of a crowd
  c.group = static_cast<std::uint32_t>(random_.below(3));
  c.is_on = chance(2);
}
void CommandDice::fill(WakeBody& c) {
  c.body = body();
}
void CommandDice::fill(SleepBody& c) {
  c.body = body();
}
void CommandDice::fill(SetAllowSleep& c) {
  c = {body(), !chance(4)};
}
void CommandDice::fill(SetGravity& c) {
  c.gravity = {{}, Acceleration::from_integer(-random_.between(5, 10)), {}};
  if (goes_wild()) c.gravity.x = number(Acceleration::from_integer(1000));
}
void CommandDice::fill(CreateJoint& c) {
  constexpr auto k_kinds = static_cast<std::uint32_t>(k_last_joint_kind);
  const auto kind =
      static_cast<JointKind>(goes_wild() ? random_.below(256) : 1 + random_.below(k_kinds));
  c.def = JointDef::of(kind, body(), body());
  c.def.frame_a.position = vector(Length(1_m));
  c.def.frame_b.position = vector(Length(1_m));
  c.def.frame_a.orientation = turn();
  if (chance(3)) fill_axis(c.def.linear[random_.below(3)]);
  if (chance(3)) fill_axis(c.def.angular[random_.below(3)]);
  if (chance(3)) c.def.break_force = Force::from_integer(random_.between(1, 90'000));
  if (goes_wild()) c.def.ratio = number(Number::from_integer(1000));
  if (goes_wild()) c.def.ground_a = vector(Position(900_m));
  c.def.collide = chance(2);
}
void CommandDice::fill(DestroyJoint& c) {
  c.joint = joint();
}
void CommandDice::fill(SetLinearAxis& c) {
  c.joint = joint(), c.axis = axis();
  fill_axis(c.settings);
}
void CommandDice::fill(SetAngularAxis& c) {
  c.joint = joint(), c.axis = axis();
  fill_axis(c.settings);
}

Command CommandDice::any() {
  if (chance(5)) return SleepBody{body()};  // most is refused or wakes again at once
  std::size_t left = random_.below(k_command_kinds);
  Command command;
#define LKS_FILL_COMMAND(Name) \
  if (left-- == 0) {           \
    Name made;                 \
    fill(made);                \
    command = made;            \
  }
  LKS_COMMANDS(LKS_FILL_COMMAND)
#undef LKS_FILL_COMMAND
  return command;
}

WorldDef crowd_def() {
  return {.body_capacity = 20,
          .pair_capacity = 512,
          .contact_capacity = 512,
          .joint_capacity = 6,
          .substeps = 2,
          .sleep_ms = 80,
          .vehicle_capacity = 3,
          .terrain_tile_capacity = 2};
}

std::shared_ptr<const AssetSet> crowd_assets() {
  return std::make_shared<const AssetSet>(std::vector{sample_height_field(), sample_panels()});
}

World make_crowd(Random& random) {
  World world = World::create(crowd_def(), crowd_assets()).value();
  add_ground(world);
  for (int i = 0; i < 12; ++i) {
    BodyDef def =
        dynamic_body(i % 3 == 0 ? Shape::sphere(0.4_m) : Shape::box(0.4_m, 0.4_m, 0.4_m),
                     Position::from_integer(i % 4 - 2), Position::from_ratio(i / 4 * 9 + 4, 10),
                     Position::from_ratio(random.between(-10, 10), 100));
    if (i == 5) def.motion = MotionType::kinematic;
    if (i == 7) def.is_trigger = true;
    if (i == 10) def.allow_sleep = false;
    add(world, def);
  }
  BodyDef terrain;
  terrain.motion = MotionType::static_body;
  terrain.shape = sample_height_field()->shape();
  terrain.position.y = -9_m;
  add(world, terrain);
  terrain.shape = sample_panels()->shape();
  terrain.position.y = -12_m;
  add(world, terrain);
  for (std::uint32_t i = 1; i < 4; ++i) {
    JointDef def = JointDef::of(i == 1 ? JointKind::distance : JointKind::six_axis,
                                world.body_at(i), world.body_at(i + 3));
    def.linear[0].upper = 2_m;
    EXPECT_TRUE(world.create_joint(def).ok());
  }
  return world;
}

std::vector<std::int64_t> told_by(const World& world) {
  std::vector<std::int64_t> told;
  for (const ContactEvent& e : world.events()) {
    told.insert(told.end(), {static_cast<std::int64_t>(e.kind), e.a.index, e.a.generation,
                             e.b.index, e.b.generation, e.approach_speed.raw, e.tag_a, e.tag_b});
  }
  for (const HitEvent& e : hit_events(world)) {
    told.insert(told.end(), {e.a.index, e.b.index, e.part_a, e.part_b, e.tag_a, e.tag_b,
                             e.approach_speed.raw, e.normal_impulse.raw});
    for (int i = 0; i < 3; ++i)
      told.insert(told.end(), {e.point[i].raw, e.normal[i].raw, e.friction_impulse[i].raw});
  }
  for (const JointEvent& e : world.joint_events())
    told.insert(told.end(), {e.joint.index, e.joint.generation, e.a.index, e.b.index});
  return told;
}

}  // namespace lockstone::test
