#include <functional>

#include <gtest/gtest.h>

#include "tests/support/sample_assets.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

constexpr ShapeKind after_last_shape() {
  return static_cast<ShapeKind>(static_cast<int>(k_last_shape_kind) + 1);
}
constexpr JointKind after_last_joint() {
  return static_cast<JointKind>(static_cast<int>(k_last_joint_kind) + 1);
}

template <class Def>
struct Wrong {
  const char* field;  ///< that `explain` names
  std::function<void(Def&)> spoil;
};

// Each change is refused, and its field is named.
template <class Def, class Refused, class Explain>
void expect_named(const std::vector<Wrong<Def>>& all, const Def& good, Refused&& refused,
                  Explain&& explain) {
  EXPECT_FALSE(refused(good)) << explain(good).to_line();
  EXPECT_EQ(explain(good).to_line(), "nothing is wrong");
  for (const Wrong<Def>& wrong : all) {
    Def def = good;
    wrong.spoil(def);
    EXPECT_TRUE(refused(def)) << wrong.field;
    const Refusal why = explain(def);
    EXPECT_EQ(why.field, wrong.field);
    EXPECT_FALSE(why.value.empty()) << wrong.field;
    EXPECT_EQ(why.rule.rfind("must be ", 0), 0U) << why.to_line();
  }
}

TEST(ExplainWorld, NamesEachFieldThatCreateRefuses) {
  using D = WorldDef;
  const std::vector<Wrong<D>> all{
      {"world.body_capacity", [](D& d) { d.body_capacity = 0; }},
      {"world.body_capacity", [](D& d) { d.body_capacity = (1U << 20) + 1; }},
      {"world.pair_capacity", [](D& d) { d.pair_capacity = 0; }},
      {"world.contact_capacity", [](D& d) { d.contact_capacity = (1U << 24) + 1; }},
      {"world.joint_capacity", [](D& d) { d.joint_capacity = (1U << 20) + 1; }},
      {"world.tick_rate", [](D& d) { d.tick_rate = 9; }},
      {"world.substeps", [](D& d) { d.substeps = 17; }},
      {"world.sleep_ms", [](D& d) { d.sleep_ms = 60'001; }},
      {"world.sleep_distance", [](D& d) { d.sleep_distance = {}; }},
      {"world.gravity.y", [](D& d) { d.gravity.y = -1001_mps2; }},
      {"world.speed_limit", [](D& d) { d.speed_limit = 501_mps; }},
      {"world.broad_phase", [](D& d) { d.broad_phase = static_cast<BroadPhaseKind>(2); }},
  };
  expect_named<D>(
      all, {.body_capacity = 4, .pair_capacity = 4, .contact_capacity = 4},
      [](const D& d) { return !World::create(d).ok(); },
      [](const D& d) { return World::explain(d); });
}

TEST(ExplainBody, NamesEachFieldThatCreateBodyRefuses) {
  World world = test::make_world();
  using D = BodyDef;
  const Unit high = Unit::from_ratio(1999, 1000);
  const std::vector<Wrong<D>> all{
      {"body.motion", [](D& d) { d.motion = static_cast<MotionType>(0); }},
      {"body.motion", [](D& d) { d.shape = Shape::half_space(); }},
      {"body.shape.kind", [](D& d) { d.shape.kind = after_last_shape(); }},
      {"body.shape.radius", [](D& d) { d.shape = Shape::sphere({}); }},
      {"body.shape.size.y", [](D& d) { d.shape.size.y = 1_m; }},
      {"body.shape.half_height", [](D& d) { d.shape = Shape::capsule(513_m, 1_m); }},
      {"body.shape.half_z", [](D& d) { d.shape = Shape::box(1_m, 1_m, 0.00009_m); }},
      {"body.shape.half_x", [](D& d) { d.shape = Shape::box(0.0009_m, 0.0009_m, 0.0009_m); }},
      {"body.shape.asset",
       [](D& d) {
         d.shape = {ShapeKind::hull, {}, {}};
       }},
      {"body.shape.asset",
       [](D& d) {
         d.shape = {ShapeKind::hull, {}, {5}};
       }},
      {"body.shape.asset", [](D& d) { d.shape.asset = {5}; }},
      {"body.position.z", [](D& d) { d.position.z = 1048577_m; }},
      {"body.orientation", [](D& d) { d.orientation.w = {}; }},
      {"body.velocity.x", [](D& d) { d.velocity.x = -501_mps; }},
      {"body.angular_velocity.y", [](D& d) { d.angular_velocity.y = 2000000_rps; }},
      {"body.material.friction", [=](D& d) { d.material.friction = high; }},
      {"body.material.restitution", [](D& d) { d.material.restitution = -0.1_r; }},
      {"body.material.rolling_resistance", [](D& d) { d.material.rolling_resistance = 1.1_r; }},
      {"body.material.density", [](D& d) { d.material.density = {}; }},
      {"body.material.friction_rule",
       [](D& d) { d.material.friction_rule = static_cast<CombineRule>(6); }},
      {"body.material.restitution_rule",
       [](D& d) { d.material.restitution_rule = static_cast<CombineRule>(6); }},
      {"body.material.rolling_rule",
       [](D& d) { d.material.rolling_rule = static_cast<CombineRule>(6); }},
      {"body.mass (volume of the shape · material.density)",
       [](D& d) { d.shape = Shape::sphere(512_m); }},
      {"body.surface_motion", [](D& d) { d.surface_motion.velocity.x = 1_mps; }},
      {"body.surface_motion.velocity.x",
       [](D& d) { d.motion = MotionType::static_body, d.surface_motion.velocity.x = 501_mps; }},
      {"body.surface_motion.turning.y",
       [](D& d) { d.motion = MotionType::static_body, d.surface_motion.turning.y = 501_rps; }},
      {"body.gravity_scale", [](D& d) { d.gravity_scale = 101_r; }},
      {"body.linear_damping", [](D& d) { d.linear_damping = -1_rps; }},
      {"body.angular_damping", [](D& d) { d.angular_damping = -1_rps; }},
      {"body.speed_limit.linear", [](D& d) { d.speed_limit.linear = {}; }},
      {"body.speed_limit.angular", [](D& d) { d.speed_limit.angular = {}; }},
  };
  expect_named<D>(
      all, {}, [&](const D& d) { return !world.create_body(d).ok(); },
      [&](const D& d) { return world.explain(d); });
}

TEST(ExplainBody, GivesValueUnitAndRange) {
  const World world = test::make_world();
  EXPECT_EQ(world.explain(BodyDef{.shape = Shape::sphere({})}).to_line(),
            "body.shape.radius: 0 m, must be 0.000977 … 512 m");
  EXPECT_EQ(World::explain(WorldDef{.tick_rate = 5}).to_line(),
            "world.tick_rate: 5 ticks/s, must be 10 … 480 ticks/s");
}

TEST(ExplainBody, SaysThatTheWorldIsFull) {
  World world = test::make_world({.body_capacity = 1, .pair_capacity = 4, .contact_capacity = 4});
  test::add(world, {});
  EXPECT_EQ(world.explain(BodyDef{}).to_line(),
            "body.count: 1, must be below WorldDef::body_capacity, 1");
}

struct Pair {
  World world = test::make_world({.body_capacity = 8, .joint_capacity = 2});
  BodyHandle a = test::add(world, {});
  BodyHandle b;
  BodyHandle wall;
  Pair() {
    BodyDef other;
    other.position.x = 2_m;
    b = test::add(world, other);
    wall = test::add(world, {.motion = MotionType::static_body});
  }
};

TEST(ExplainJoint, NamesEachFieldThatCreateJointRefuses) {
  Pair pair;
  using D = JointDef;
  const std::vector<Wrong<D>> all{
      {"joint.body_a", [](D& d) { d.body_a = {}; }},
      {"joint.body_b",
       [](D& d) {
         d.body_b = {77, 1};
       }},
      {"joint.body_b", [](D& d) { d.body_b = d.body_a; }},
      {"joint.kind", [](D& d) { d.kind = after_last_joint(); }},
      {"joint.frame_a.orientation", [](D& d) { d.frame_a.orientation.w = {}; }},
      {"joint.frame_b.orientation", [](D& d) { d.frame_b.orientation.w = {}; }},
      {"joint.frame_a.position", [](D& d) { d.frame_a.position.y = 300_m; }},
      {"joint.frame_b.position", [](D& d) { d.frame_b.position.y = 300_m; }},
      {"joint.linear[1].mode", [](D& d) { d.linear[1].mode = static_cast<AxisMode>(3); }},
      {"joint.linear[0].hertz", [](D& d) { d.linear[0].hertz = 1001_r; }},
      {"joint.linear[2].damping_ratio", [](D& d) { d.linear[2].damping_ratio = -1_r; }},
      {"joint.linear[2].max_effort", [](D& d) { d.linear[2].max_effort = -1_N; }},
      {"joint.linear[0].lower", [](D& d) { d.linear[0].lower = 1_m; }},
      {"joint.angular[0].hertz", [](D& d) { d.angular[0].hertz = -1_r; }},
      {"joint.angular[2].upper", [](D& d) { d.angular[2].upper = 4_rad; }},
      {"joint.angular[2].lower", [](D& d) { d.angular[2].lower = -4_rad; }},
      {"joint.angular[1].target", [](D& d) { d.angular[1].target = 4_rad; }},
      {"joint.angular[1].upper",
       [](D& d) { d.kind = JointKind::ball, d.angular[1].lower = d.angular[1].upper = -1_rad; }},
      {"joint.linear[0].lower",
       [](D& d) { d.kind = JointKind::distance, d.linear[0].lower = -1_m; }},
      {"joint.ratio", [](D& d) { d.ratio = 1001_r; }},
      {"joint.ratio", [](D& d) { d.kind = JointKind::pulley, d.ratio = {}; }},
      {"joint.ground_a.x", [](D& d) { d.ground_a.x = 1048577_m; }},
      {"joint.ground_b.y", [](D& d) { d.ground_b.y = -1048577_m; }},
      {"joint.ground_a", [](D& d) { d.kind = JointKind::pulley, d.ground_a.x = 2000_m; }},
      {"joint.break_force", [](D& d) { d.break_force = -1_N; }},
      {"joint.break_torque", [](D& d) { d.break_torque = -1_Nm; }},
  };
  const auto refused = [&](const D& d) {
    const Result<JointHandle> made = pair.world.create_joint(d);
    if (made.ok()) (void)pair.world.apply(DestroyJoint{made.value()});
    return !made.ok();
  };
  expect_named<D>(all, JointDef::of(JointKind::hinge, pair.a, pair.b), refused,
                  [&](const D& d) { return pair.world.explain(d); });
}

TEST(JointDef, WithoutItsKindsLocksIsRefused) {
  Pair pair;
  for (const JointKind kind :
       {JointKind::ball, JointKind::hinge, JointKind::slider, JointKind::weld, JointKind::wheel}) {
    JointDef def{.kind = kind, .body_a = pair.a, .body_b = pair.b};
    EXPECT_EQ(pair.world.create_joint(def).status(), Status::invalid_argument) << to_string(kind);
    EXPECT_NE(pair.world.explain(def).to_line().find("JointDef::of"), std::string::npos);
    def.linear[0].mode = def.linear[1].mode = def.linear[2].mode = AxisMode::locked;
    EXPECT_TRUE(pair.world.create_joint(def).ok()) << to_string(kind);
    pair = Pair();
  }
}

TEST(JointDef, OfAnyKindIsAccepted) {
  for (int i = 1; i <= static_cast<int>(k_last_joint_kind); ++i) {
    if (i == static_cast<int>(JointKind::path)) continue;  // needs a path: see PathJoints
    Pair pair;
    const auto kind = static_cast<JointKind>(i);
    const JointDef def = JointDef::of(kind, pair.a, pair.b);
    EXPECT_TRUE(pair.world.create_joint(def).ok()) << to_string(kind);
  }
}

// Good and bad commands for two bodies, a wall and a joint.
std::vector<Command> sample_commands(const Pair& p, JointHandle joint) {
  const Position far = 1048577_m;
  const Quat none{{}, {}, {}, {}};
  return {
      Command{},
      DestroyBody{{9, 9}},
      Teleport{p.a, {far, {}, {}}, {}},
      Teleport{p.a, {}, none},
      Teleport{p.a, {1_m, {}, {}}, {}},
      SetVelocity{p.wall, {}},
      SetVelocity{p.a, {501_mps, {}, {}}},
      SetAngularVelocity{p.a, {2000000_rps, {}, {}}},
      SetAngularVelocity{p.wall, {}},
      ApplyImpulse{p.wall, {}, {}},
      ApplyImpulse{p.a, {}, static_cast<Frame>(2)},
      ApplyImpulseAt{p.a, {}, {9_m, {}, {}}, {}},
      ApplyImpulseAt{p.a, {1_Ns, {}, {}}, {0.1_m, {}, {}}, Frame::body},
      ApplyAngularImpulse{p.wall, {}, {}},
      ApplyForce{{}, {}, {}},
      ApplyForceAt{p.a, {}, {9_m, {}, {}}, {}},
      ApplyTorque{p.a, {1_Nm, {}, {}}, {}},
      MoveKinematic{p.a, {}, {}},
      SetMaterial{p.a, {.friction = -0.1_r}},
      SetSurfaceMotion{p.a, {}},
      SetSurfaceMotion{p.wall, {.velocity = {600_mps, {}, {}}}},
      SetSurfaceMotion{p.wall, {}},
      SetGravityScale{p.a, 101_r},
      SetDamping{p.a, -1_rps, {}},
      SetDamping{p.a, {}, -1_rps},
      SetAxisLocks{p.wall, {}},
      SetAxisLocks{p.a, {.move_x = true}},
      SetSpeedLimit{p.a, {.linear = {}}},
      SetFilter{{}, {}},
      SetUserData{{5, 1}, 0},
      WakeBody{p.wall},
      SleepBody{p.wall},
      SleepBody{p.a},
      SetAllowSleep{p.wall, false},
      SetGravity{{{}, 1001_mps2, {}}},
      CreateBody{BodyDef{.shape = Shape::sphere({})}},
      CreateJoint{JointDef{.body_a = p.a, .body_b = p.b}},
      DestroyJoint{{7, 7}},
      SetLinearAxis{joint, 3, {}},
      SetLinearAxis{joint, 0, {.hertz = -1_r}},
      SetAngularAxis{joint, 1, {.lower = 1_rad}},
      SetAngularAxis{joint, 1, {}},
  };
}

TEST(ExplainCommand, SaysWhyExactlyWhereApplyRefuses) {
  const std::size_t count = sample_commands(Pair(), {}).size();
  for (std::size_t i = 0; i < count; ++i) {
    Pair pair;
    const JointDef hinge = JointDef::of(JointKind::hinge, pair.a, pair.b);
    const Command command = sample_commands(pair, pair.world.create_joint(hinge).value())[i];
    const Refusal why = pair.world.explain(command);
    const Status status = pair.world.apply(command);
    EXPECT_EQ(static_cast<bool>(why), status != Status::ok)
        << i << ' ' << name_of(command) << ": " << why.to_line() << ", " << to_string(status);
  }
}

TEST(ExplainCommand, NamesTheFieldThatRefusesADistantKinematicMove) {
  Pair pair;
  const BodyHandle lift = test::add(pair.world, {.motion = MotionType::kinematic});
  EXPECT_FALSE(pair.world.explain(MoveKinematic{lift, {1_m, {}, {}}, {}}));
  const Refusal why = pair.world.explain(MoveKinematic{lift, {100_m, {}, {}}, {}});
  EXPECT_EQ(why.field, "MoveKinematic.position");
}

using MisuseDeathTest = ::testing::Test;

TEST(MisuseDeathTest, NamesTheFunctionTheHandleAndTheRemedy) {
  Pair pair;
  const World& world = pair.world;
  const char* text = "handle .3, 1. names no body .destroyed.*; ask World::exists first";
  EXPECT_DEATH((void)world.position({3, 1}), std::string("World::position: ") + text);
  EXPECT_DEATH((void)world.velocity({3, 1}), std::string("World::velocity: ") + text);
  EXPECT_DEATH((void)world.body({3, 1}), std::string("World::body: ") + text);
  EXPECT_DEATH((void)world.mass({3, 1}), std::string("World::mass: ") + text);
  EXPECT_DEATH((void)world.joint({}), "World::joint: handle .0, 0. names no joint");
  EXPECT_DEATH((void)world.cast_ray({}, {513_m, {}, {}}), "World::cast_ray.*k_max_cast");
  EXPECT_DEATH((void)world.closest_point({}, -1_m), "World::closest_point: `reach`");
  EXPECT_DEATH((void)World::create({.tick_rate = 0}).value(),
               "Result::value.*invalid argument.*World::explain");
}

}  // namespace
}  // namespace lockstone
