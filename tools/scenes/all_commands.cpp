// One scene that uses every command there is. The manifest lists them: a command without a sample
// here does not compile.
#include <array>
#include <type_traits>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

template <class T>
using Tag = std::type_identity<T>;

Velocity speed(Random& random) {
  return Velocity::from_ratio(random.between(-3000, 3000), 1000);
}
Impulse push(Random& random) {
  return Impulse::from_integer(random.between(-600, 600));
}

Vec3<Impulse> random_impulse(Random& random) {
  const Impulse x = push(random), z = push(random);
  return {x, Impulse::from_integer(random.between(0, 900)), z};
}

Command sample(Tag<CreateBody>, BodyHandle, Random& random) {
  BodyDef def = loose(random_shape(random), {{}, 6_m, {}});
  def.linear_damping = 0.1_rps;
  def.gravity_scale = Number::from_ratio(random.between(5, 10), 10);
  return CreateBody{def};
}
Command sample(Tag<DestroyBody>, BodyHandle body, Random&) {
  return DestroyBody{body};
}
Command sample(Tag<Teleport>, BodyHandle body, Random& random) {
  const Position x = millimetres(random.between(-4000, 4000));
  return Teleport{body, {x, 3_m, {}}, random_orientation(random)};
}
Command sample(Tag<SetVelocity>, BodyHandle body, Random& random) {
  const Velocity x = speed(random), z = speed(random);
  return SetVelocity{body, {x, {}, z}};
}
Command sample(Tag<SetAngularVelocity>, BodyHandle body, Random& random) {
  return SetAngularVelocity{body, {{}, AngularVelocity::from_integer(random.between(-9, 9)), {}}};
}
Command sample(Tag<ApplyImpulse>, BodyHandle body, Random& random) {
  return ApplyImpulse{body, random_impulse(random)};
}
Command sample(Tag<ApplyImpulseAt>, BodyHandle body, Random& random) {
  return ApplyImpulseAt{body, random_impulse(random), {0.1_m, {}, -0.1_m}};
}
Command sample(Tag<ApplyAngularImpulse>, BodyHandle body, Random& random) {
  const auto x = AngularImpulse::from_integer(random.between(-50, 50));
  return ApplyAngularImpulse{body, {x, {}, {}}};
}
Command sample(Tag<ApplyForce>, BodyHandle body, Random& random) {
  return ApplyForce{body, {{}, Force::from_integer(random.between(0, 20000)), {}}};
}
Command sample(Tag<ApplyForceAt>, BodyHandle body, Random& random) {
  const Force up = Force::from_integer(random.between(0, 20000));
  return ApplyForceAt{body, {{}, up, {}}, {0.1_m, {}, {}}, Frame::body};
}
Command sample(Tag<ApplyTorque>, BodyHandle body, Random& random) {
  return ApplyTorque{body, {{}, Torque::from_integer(random.between(-2000, 2000)), {}}};
}
Command sample(Tag<SetMaterial>, BodyHandle body, Random& random) {
  const Coefficient friction = Coefficient::from_ratio(random.between(0, 10), 10);
  Surface surface{friction, 0.5_r, 0.01_r};
  surface.friction_rule = static_cast<CombineRule>(random.below(6));
  return SetMaterial{body, surface};
}
Command sample(Tag<SetSurfaceMotion>, BodyHandle body, Random& random) {
  return SetSurfaceMotion{
      body, {{SolverVelocity::from_integer(random.between(-2, 2)), {}, {}}, {{}, 1_rps, {}}}};
}
Command sample(Tag<SetGravityScale>, BodyHandle body, Random& random) {
  return SetGravityScale{body, Number::from_ratio(random.between(5, 15), 10)};
}
Command sample(Tag<SetDamping>, BodyHandle body, Random& random) {
  const Rate rate = Rate::from_ratio(random.between(0, 10), 10);
  return SetDamping{body, rate, rate};
}
Command sample(Tag<SetAxisLocks>, BodyHandle body, Random& random) {
  const std::uint32_t bits = random.below(64);
  return SetAxisLocks{body,
                      {(bits & 1) != 0, false, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0,
                       (bits & 32) != 0}};
}
Command sample(Tag<SetSpeedLimit>, BodyHandle body, Random& random) {
  return SetSpeedLimit{body, {Velocity::from_integer(random.between(3, 30)), 20_rps}};
}
Command sample(Tag<MoveKinematic>, BodyHandle body, Random& random) {
  const Position x = millimetres(random.between(-4000, 4000));
  return MoveKinematic{body, {x, 1_m, {}}, {}};
}
Command sample(Tag<SetFilter>, BodyHandle body, Random& random) {
  const std::uint32_t category = random.below(4) == 0 ? 2 : 1;
  return SetFilter{body, {category, 0xffffffff, 0}};
}
Command sample(Tag<SetUserData>, BodyHandle body, Random& random) {
  return SetUserData{body, random.next()};
}
// On the ground, which is body 0.
Command sample(Tag<CreateJoint>, BodyHandle body, Random& random) {
  const JointKind kind = random.below(2) == 0 ? JointKind::ball : JointKind::distance;
  JointDef def = JointDef::of(kind, {0, 1}, body);
  def.frame_a.position = {Length::from_integer(random.between(-3, 3)), 4_m, {}};
  def.linear[0].upper = 2_m;
  def.linear[0].mode = kind == JointKind::ball ? AxisMode::locked : AxisMode::limited;
  return CreateJoint{def};
}
Command sample(Tag<DestroyJoint>, BodyHandle, Random& random) {
  return DestroyJoint{{random.below(4), 1}};
}
Command sample(Tag<SetLinearAxis>, BodyHandle, Random& random) {
  LinearAxis axis;
  axis.mode = AxisMode::locked;
  axis.hertz = Number::from_integer(random.between(0, 9));
  return SetLinearAxis{{random.below(4), 1}, 0, axis};
}
Command sample(Tag<SetAngularAxis>, BodyHandle, Random& random) {
  AngularAxis axis;
  axis.speed = Rate::from_integer(random.between(-9, 9));
  axis.max_effort = Torque::from_integer(500);
  return SetAngularAxis{{random.below(4), 1}, 0, axis};
}
Command sample(Tag<SetEvents>, BodyHandle body, Random& random) {
  return SetEvents{body, {true, SolverVelocity::from_integer(random.between(0, 3))}};
}
Command sample(Tag<SetMotionType>, BodyHandle body, Random& random) {
  return SetMotionType{body, static_cast<MotionType>(1 + random.below(3)), {}};
}
Command sample(Tag<SetShape>, BodyHandle body, Random& random) {
  return SetShape{body, random_shape(random), {}};
}
Command sample(Tag<SetMassData>, BodyHandle body, Random& random) {
  return SetMassData{body, {Mass::from_integer(random.between(1, 900)), {}}};
}
Command sample(Tag<SetEnabled>, BodyHandle body, Random& random) {
  return SetEnabled{body, random.below(3) != 0};
}
Command sample(Tag<SetFluid>, BodyHandle, Random& random) {
  Fluid water{.surface = {{}, millimetres(random.between(0, 2000)), {}}, .size = {5_m, 5_m, 5_m}};
  water.density = Density::from_integer(1000);
  return SetFluid{random.below(2), water};
}
Command sample(Tag<SetPairRule>, BodyHandle body, Random& random) {
  return SetPairRule{body, body, {random.below(2) == 0, {}}};
}
Command sample(Tag<SetSurfaceRule>, BodyHandle, Random& random) {
  return SetSurfaceRule{0, 0, PairSurface{Coefficient::from_ratio(random.between(0, 9), 10)}};
}
Command sample(Tag<SetOneWay>, BodyHandle body, Random&) {
  return SetOneWay{body, {.direction = {{}, Unit::from_integer(1), {}}}};
}
Command sample(Tag<SetVehicle>, BodyHandle body, Random&) {
  return SetVehicle{body, make_car(2_m, 0.5_m, {}, Torque::from_integer(100))};
}
Command sample(Tag<DriveVehicle>, BodyHandle body, Random&) {
  return DriveVehicle{body, {.throttle = Unit::from_integer(1)}};
}
Command sample(Tag<SetHeights>, BodyHandle body, Random&) {
  static constexpr std::array<Length, 1> k_height{Length::from_integer(1)};
  return SetHeights{.body = body, .heights = k_height};
}
Command sample(Tag<SetMeshGroup>, BodyHandle body, Random&) {
  return SetMeshGroup{.body = body};
}
Command sample(Tag<WakeBody>, BodyHandle body, Random&) {
  return WakeBody{body};
}
Command sample(Tag<SleepBody>, BodyHandle body, Random&) {
  return SleepBody{body};
}
Command sample(Tag<SetAllowSleep>, BodyHandle body, Random& random) {
  return SetAllowSleep{body, random.below(4) != 0};
}
Command sample(Tag<SetGravity>, BodyHandle, Random& random) {
  const Acceleration x = Acceleration::from_ratio(random.between(-200, 200), 100);
  return SetGravity{{x, -9.81_mps2, {}}};
}

using Sampler = Command (*)(BodyHandle, Random&);

#define LKS_SAMPLER(Name) \
  [](BodyHandle body, Random& random) -> Command { return sample(Tag<Name>{}, body, random); },
constexpr Sampler k_samplers[] = {LKS_COMMANDS(LKS_SAMPLER)};
#undef LKS_SAMPLER

// From SetEvents on they have no turn: all others would move to other ticks.
constexpr std::size_t k_turns = Command(SetEvents{}).index() - 1;

void build_commands(World& world, std::uint64_t seed) {
  add_ground(world, 12_m);
  Random random(mix(seed));
  for (int i = 0; i < 12; ++i) {
    add(world, loose(random_shape(random),
                     {millimetres(i % 4 * 1500 - 2250), 1_m, millimetres(i / 4 * 1500 - 1500)}));
  }
}

// Each command in turn, one a tick, on whatever body chance picks; some name bodies that are gone
// and must be refused alike everywhere.
void drive_commands(World& world, std::uint64_t seed) {
  Random random(mix(seed ^ mix(world.tick() + 1)));
  const BodyHandle body = world.body_at(1 + random.below(world.body_limit() - 1));
  const Sampler sampler = k_samplers[world.tick() % k_turns];
  static_cast<void>(world.apply(sampler(body, random)));
}

}  // namespace

constinit const Scene k_commands{
    "commands",    "every command in turn on random bodies", 260, small_world, build_commands,
    drive_commands};

}  // namespace lockstone::scenes
