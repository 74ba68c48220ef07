// Ratchets: hinges that turn one way.

#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

constexpr double k_turn = 6.283185307179586;

// A wheel about the x axis of the world, as a ratchet on a static body.
struct Wheel {
  World world;
  JointDef def;
  JointHandle joint;
  int teeth;

  explicit Wheel(int teeth_in_a_turn, Vec3<Acceleration> gravity = {},
                 const Shape& shape = Shape::box(0.1_m, 0.5_m, 0.5_m))
      : world(test::make_world({.body_capacity = 4, .gravity = gravity})), teeth(teeth_in_a_turn) {
    BodyDef body = test::dynamic_body(shape, {}, {}, {});
    body.allow_sleep = false;
    def = JointDef::of(JointKind::ratchet, test::add_fixed(world), test::add(world, body));
    def.ratio = Number::from_integer(teeth);
  }
  void make() { joint = test::join(world, def); }
  void turn(Torque torque, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      ASSERT_EQ(world.apply(ApplyTorque{def.body_b, {torque, {}, {}}}), Status::ok);
      (void)world.step();
    }
  }
  void spin(AngularVelocity rate) {
    ASSERT_EQ(world.apply(SetAngularVelocity{def.body_b, {rate, {}, {}}}), Status::ok);
  }
  [[nodiscard]] double angle() const { return to_double(world.joint(joint).angle.x); }
  [[nodiscard]] double rate() const { return to_double(world.body(def.body_b).angular_velocity.x); }
  // The angle beyond the tooth below it.
  [[nodiscard]] double beyond_tooth(double at) const {
    const double tooth = k_turn / teeth;
    return at - tooth * std::floor((at + 1e-3) / tooth);
  }
};

TEST(Ratchets, TurnFreelyForward) {
  Wheel wheel(12);
  wheel.make();
  wheel.spin(AngularVelocity::from_integer(20));
  test::step(wheel.world, 600);
  EXPECT_NEAR(wheel.rate(), 20, 1e-6);
}

// As the same hinge without teeth does turn back.
TEST(Ratchets, HoldTheTeethThatTheyPassed) {
  for (const int teeth : {2, 3, 12, 100, 1000}) {
    Wheel wheel(teeth), hinge(teeth);
    hinge.def.kind = JointKind::hinge;
    hinge.def.angular[0].mode = AxisMode::free;
    hinge.def.ratio = 1_r;
    wheel.make();
    hinge.make();
    for (Wheel* each : {&wheel, &hinge}) {
      each->spin(AngularVelocity::from_integer(3));
      test::step(each->world, 80);
      each->spin({});
    }
    const double reached = wheel.angle();
    wheel.turn(-2000_Nm, 240);
    hinge.turn(-2000_Nm, 240);
    const double expected = reached - wheel.beyond_tooth(reached);
    EXPECT_NEAR(std::remainder(wheel.angle() - expected, k_turn), 0, 1e-3) << teeth << " teeth";
    EXPECT_NEAR(wheel.rate(), 0, 1e-3) << teeth << " teeth";
    EXPECT_LT(hinge.rate(), -1) << teeth << " teeth";
  }
}

// An arm with a weight that hangs on a tooth of 6 mrad; a minute.
TEST(Ratchets, HoldALoadWithoutCreep) {
  Wheel wheel(1000, {{}, {}, -9.81_mps2}, Shape::box(0.1_m, 1_m, 0.1_m));
  wheel.def.frame_b.position.y = -1_m;  // from the arm's end: gravity turns it back about x
  ASSERT_EQ(wheel.world.apply(Teleport{wheel.def.body_b, {{}, 1_m, {}}, {}}), Status::ok);
  wheel.make();
  test::step(wheel.world, 60);
  const double first = wheel.angle();
  EXPECT_NEAR(first, 0, 1e-3);
  test::step(wheel.world, 3600);
  EXPECT_NEAR(wheel.angle(), first, 1e-6);
}

TEST(Ratchets, GainNoEnergyWhereTeethStopThem) {
  for (const int teeth : {2, 7, 64}) {
    Wheel wheel(teeth);
    wheel.make();
    for (int hit = 0; hit < 20; ++hit) {
      wheel.spin(AngularVelocity::from_integer(hit % 2 == 0 ? 1 + hit : -1 - 2 * hit));
      double before = std::abs(wheel.rate());
      for (int tick = 0; tick < 30; ++tick) {
        (void)wheel.world.step();
        ASSERT_LT(std::abs(wheel.rate()), before + 1e-6) << "hit " << hit << ", tick " << tick;
        before = std::abs(wheel.rate());
      }
      EXPECT_GT(wheel.rate(), -1e-3) << "hit " << hit;
    }
  }
}

// 188 rad/s are half a turn a tick.
TEST(Ratchets, KeepCountWhenTheyAreFast) {
  Wheel wheel(8);
  wheel.make();
  wheel.spin(AngularVelocity::from_integer(180));
  test::step(wheel.world, 100);
  EXPECT_NEAR(wheel.rate(), 180, 1e-3);
}

TEST(Ratchets, LetGoWhileThePawlIsLifted) {
  Wheel wheel(12);
  wheel.make();
  AngularAxis lifted;
  ASSERT_EQ(wheel.world.apply(SetAngularAxis{wheel.joint, 0, lifted}), Status::ok);
  wheel.spin(AngularVelocity::from_integer(-4));
  test::step(wheel.world, 60);
  EXPECT_NEAR(wheel.rate(), -4, 1e-6);
  const double reached = wheel.angle();
  lifted.mode = AxisMode::limited;
  ASSERT_EQ(wheel.world.apply(SetAngularAxis{wheel.joint, 0, lifted}), Status::ok);
  test::step(wheel.world, 60);
  EXPECT_NEAR(wheel.rate(), 0, 1e-3);
  EXPECT_NEAR(std::remainder(wheel.angle() - reached + wheel.beyond_tooth(reached), k_turn), 0,
              1e-3);
}

TEST(Ratchets, HaveAMotorAndFriction) {
  Wheel wheel(12);
  wheel.def.angular[0].speed = 5_rps;
  wheel.def.angular[0].max_effort = 5000_Nm;
  wheel.make();
  test::step(wheel.world, 120);
  EXPECT_NEAR(wheel.rate(), 5, 1e-3);
  AngularAxis back = wheel.def.angular[0];
  back.speed = -5_rps;
  ASSERT_EQ(wheel.world.apply(SetAngularAxis{wheel.joint, 0, back}), Status::ok);
  test::step(wheel.world, 120);
  EXPECT_NEAR(wheel.rate(), 0, 1e-3);
}

TEST(Ratchets, RefuseTeethThatAreNone) {
  for (const Number ratio : std::initializer_list<Number>{0_r, 1_r, 1001_r, 2.5_r, -12_r}) {
    Wheel wheel(12);
    wheel.def.ratio = ratio;
    EXPECT_EQ(wheel.world.create_joint(wheel.def).status(), Status::invalid_argument);
    EXPECT_EQ(wheel.world.explain(wheel.def).field, "joint.ratio");
  }
}

// The tooth is part of the state: a copy goes on in the same way.
TEST(Ratchets, ComeBackFromASnapshot) {
  Wheel wheel(12), copy(12);
  wheel.make();
  copy.make();
  wheel.spin(AngularVelocity::from_integer(7));
  test::step(wheel.world, 33);
  ASSERT_EQ(
      copy.world.load(SnapshotKind::canonical, test::save(wheel.world, SnapshotKind::canonical)),
      Status::ok);
  for (Wheel* each : {&wheel, &copy})
    each->turn(-500_Nm, 60);
  EXPECT_EQ(wheel.world.hash().total, copy.world.hash().total);
}

}  // namespace
}  // namespace lockstone
