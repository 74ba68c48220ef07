// The events that wake a sleeper, one by one, and those that do not.

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/sleep/sleepers.h"

namespace lockstone {
namespace {

using namespace literals;
using test::add_stack;
using test::all_asleep;
using test::asleep;
using test::Sleepers;
using test::unit_box;

// The events that wake a stack that sleeps on the ground, each with a name.
struct Cause {
  const char* word;
  std::function<void(Sleepers&)> work;
  int ticks = 1;  // later it is awake
};

void apply(Sleepers& scene, const Command& command) {
  ASSERT_EQ(scene.world.apply(command), Status::ok);
}

std::vector<Cause> causes() {
  return {
      {"wake", [](Sleepers& s) { apply(s, WakeBody{s.stack[2]}); }},
      {"velocity",
       [](Sleepers& s) {
         apply(s, SetVelocity{s.stack[2], {}});
       }},
      {"angular velocity",
       [](Sleepers& s) {
         apply(s, SetAngularVelocity{s.stack[1], {}});
       }},
      {"impulse",
       [](Sleepers& s) {
         apply(s, ApplyImpulse{s.stack[2], {{}, Impulse::from_integer(1), {}}});
       }},
      {"angular impulse",
       [](Sleepers& s) {
         apply(s, ApplyAngularImpulse{s.stack[2], {{}, AngularImpulse::from_integer(1), {}}});
       }},
      {"force",
       [](Sleepers& s) {
         apply(s, ApplyForce{s.stack[2], {Force::from_integer(9), {}, {}}});
       }},
      {"force at a point",
       [](Sleepers& s) {
         apply(s, ApplyForceAt{s.stack[2], {Force::from_integer(9), {}, {}}, {{}, 0.5_m, {}}});
       }},
      {"impulse at a point",
       [](Sleepers& s) {
         apply(s, ApplyImpulseAt{s.stack[2], {Impulse::from_integer(1), {}, {}}, {{}, 0.5_m, {}}});
       }},
      {"torque",
       [](Sleepers& s) {
         apply(s, ApplyTorque{s.stack[2], {{}, Torque::from_integer(9), {}}});
       }},
      {"gravity scale of a member",
       [](Sleepers& s) {
         apply(s, SetGravityScale{s.stack[2], 2_r});
       }},
      {"axis locks of a member",
       [](Sleepers& s) {
         apply(s, SetAxisLocks{s.stack[2], {.move_x = true}});
       }},
      {"a member that may not sleep",
       [](Sleepers& s) {
         apply(s, SetAllowSleep{s.stack[2], false});
       }},
      {"the ground runs like a belt",
       [](Sleepers& s) {
         apply(s, SetSurfaceMotion{s.ground, {.velocity = {1_mps, {}, {}}}});
       }},
      {"a joint to the ground",
       [](Sleepers& s) {
         (void)s.world.create_joint(JointDef::of(JointKind::weld, s.ground, s.stack[2]));
       }},
      {"a body made in it",
       [](Sleepers& s) {
         test::add(s.world, test::dynamic_body(Shape::sphere(0.3_m), 0.6_m, 2_m, {}));
       },
       2},
      {"teleport of a member",
       [](Sleepers& s) {
         apply(s, Teleport{s.stack[2], {9_m, 9_m, {}}, {}});
       }},
      {"end of a member", [](Sleepers& s) { apply(s, DestroyBody{s.stack[2]}); }},
      {"material of a member",
       [](Sleepers& s) {
         apply(s, SetMaterial{s.stack[0], {{}, {}}});
       }},
      {"filter of a member",
       [](Sleepers& s) {
         apply(s, SetFilter{s.stack[1], {2, 2, 0}});
       }},
      {"teleport of the ground",
       [](Sleepers& s) {
         apply(s, Teleport{s.ground, {{}, -20_m, {}}, {}});
       }},
      {"end of the ground", [](Sleepers& s) { apply(s, DestroyBody{s.ground}); }},
      {"material of the ground",
       [](Sleepers& s) {
         apply(s, SetMaterial{s.ground, {{}, {}}});
       }},
      {"filter of the ground",
       [](Sleepers& s) {
         apply(s, SetFilter{s.ground, {2, 2, 0}});
       }},
      {"gravity",
       [](Sleepers& s) {
         apply(s, SetGravity{{{}, 1_mps2, {}}});
       }},
      {"a static body in its place",
       [](Sleepers& s) {
         BodyDef wall;
         wall.motion = MotionType::static_body;
         wall.position = {0.7_m, 2_m, {}};
         test::add(s.world, wall);
       }},
      {"a ball that falls on it",
       [](Sleepers& s) {
         test::add(s.world, test::dynamic_body(Shape::sphere(0.3_m), {}, 4_m, {}));
       },
       40},
      {"a kinematic body that comes",
       [](Sleepers& s) {
         BodyDef bar;
         bar.motion = MotionType::kinematic;
         bar.position = {2_m, 2_m, {}};
         bar.velocity = {-2_mps, {}, {}};
         test::add(s.world, bar);
       },
       40},
  };
}

TEST(Wake, HasManyCauses) {
  for (const Cause& cause : causes()) {
    SCOPED_TRACE(cause.word);
    Sleepers scene;
    cause.work(scene);
    test::step(scene.world, cause.ticks);
    EXPECT_FALSE(asleep(scene.world, scene.stack[0]));
    EXPECT_FALSE(asleep(scene.world, scene.stack[1]));
  }
}

// A lamp that sleeps, hung by a hinge on a bracket of one kind or another.
struct Lamp {
  World world = test::make_world();
  BodyHandle bracket, lamp;
  JointHandle hinge;

  explicit Lamp(MotionType motion) {
    BodyDef def;
    def.motion = motion;
    def.position = {{}, 5_m, {}};
    bracket = test::add(world, def);
    lamp = test::add(world, test::dynamic_body(unit_box(), {}, 3_m, {}));
    JointDef joint = JointDef::of(JointKind::hinge, bracket, lamp);
    joint.frame_b.position = {{}, 2_m, {}};
    hinge = world.create_joint(joint).value();
    test::step(world, 60);
    EXPECT_TRUE(asleep(world, lamp));
  }
};

struct LampCause {
  const char* word;
  std::function<void(Lamp&)> work;
  MotionType bracket = MotionType::static_body;
};

void order(Lamp& scene, const Command& command) {
  ASSERT_EQ(scene.world.apply(command), Status::ok);
}

std::vector<LampCause> lamp_causes() {
  const auto turn = [](Lamp& s, AngularAxis axis) { order(s, SetAngularAxis{s.hinge, 0, axis}); };
  return {
      {"the end of the joint", [](Lamp& s) { order(s, DestroyJoint{s.hinge}); }},
      {"a motor",
       [=](Lamp& s) { turn(s, {.speed = 1_rps, .max_effort = Torque::from_integer(100)}); }},
      {"a limit",
       [=](Lamp& s) { turn(s, {.mode = AxisMode::limited, .lower = 0.1_rad, .upper = 0.5_rad}); }},
      {"a spring",
       [=](Lamp& s) { turn(s, {.target = 0.5_rad, .hertz = 2_r, .damping_ratio = 1_r}); }},
      {"the end of a static bracket", [](Lamp& s) { order(s, DestroyBody{s.bracket}); }},
      {"a static bracket elsewhere",
       [](Lamp& s) {
         order(s, Teleport{s.bracket, {1_m, 5_m, {}}, {}});
       }},
      {"the end of a kinematic bracket", [](Lamp& s) { order(s, DestroyBody{s.bracket}); },
       MotionType::kinematic},
      {"a kinematic bracket elsewhere",
       [](Lamp& s) {
         order(s, Teleport{s.bracket, {1_m, 5_m, {}}, {}});
       },
       MotionType::kinematic},
      {"a kinematic bracket that begins to move",
       [](Lamp& s) {
         order(s, SetVelocity{s.bracket, {1_mps, {}, {}}});
       },
       MotionType::kinematic},
      {"a kinematic bracket that is moved",
       [](Lamp& s) {
         order(s, MoveKinematic{s.bracket, {0.1_m, 5_m, {}}, {}});
       },
       MotionType::kinematic},
  };
}

TEST(Wake, ReachesJoinedBodies) {
  for (const LampCause& cause : lamp_causes()) {
    SCOPED_TRACE(cause.word);
    Lamp scene(cause.bracket);
    const Vec3<Position> before = scene.world.position(scene.lamp);
    cause.work(scene);
    test::step(scene.world, 1);
    EXPECT_FALSE(asleep(scene.world, scene.lamp));
    test::step(scene.world, 10);
    EXPECT_NE(scene.world.position(scene.lamp), before);
  }
}

TEST(Wake, IsNotCausedByCommandsThatChangeNothing) {
  Sleepers scene;
  const std::vector<BodyHandle> far = add_stack(scene.world, 20_m, 1);
  apply(scene, SetUserData{scene.stack[0], 7});
  apply(scene, ApplyForce{scene.stack[0], {}});
  apply(scene, SetGravity{scene.world.def().gravity});
  apply(scene, DestroyBody{far[0]});
  test::step(scene.world, 2);
  EXPECT_TRUE(all_asleep(scene.world, scene.stack));
  EXPECT_TRUE(scene.world.events().empty());
}

TEST(Wake, IsToldByEventsInOrderOfBodies) {
  Sleepers scene;
  apply(scene, WakeBody{scene.stack[1]});
  (void)scene.world.step();
  ASSERT_EQ(scene.world.events().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.world.events()[i].kind, EventKind::wake);
    EXPECT_EQ(scene.world.events()[i].a, scene.stack[i]);
    EXPECT_TRUE(scene.world.events()[i].b.is_null());
  }
}

TEST(Wake, ABulletThatHitsASleeperWakesItsIsland) {
  Sleepers scene;
  BodyDef bullet = test::dynamic_body(Shape::sphere(0.05_m), -30_m, 1.5_m, {});
  bullet.is_bullet = true;
  bullet.velocity = {400_mps, {}, {}};
  bullet.material.density = Density::from_integer(20000);
  test::add(scene.world, bullet);
  test::step(scene.world, 8);
  EXPECT_FALSE(asleep(scene.world, scene.stack[0]));
  EXPECT_GT(scene.world.velocity(scene.stack[1]).x, Velocity(0.1_mps));
}

}  // namespace
}  // namespace lockstone
