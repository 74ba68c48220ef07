// Limits, motors and springs of joints.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::add_fixed, test::gap, test::join, test::number;

// A bar of 40 kg that turns about z at its end.
struct Lever {
  World world = test::make_world();
  JointDef def = hinge();
  JointHandle joint = join(world, def);

  JointDef hinge() {
    JointDef hinge = JointDef::of(JointKind::hinge, add_fixed(world), {});
    hinge.body_b =
        test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.1_m, 0.1_m), 0.5_m, {}, {}));
    hinge.frame_a.orientation = from_axis_angle({{}, 1_r, {}}, -1.570796327_rad);
    hinge.frame_b.orientation = hinge.frame_a.orientation;
    hinge.frame_b.position.x = -0.5_m;
    return hinge;
  }
  double angle() { return number(world.joint(joint).angle.x.raw, 27); }
  void set(const AngularAxis& axis) {
    ASSERT_EQ(world.apply(SetAngularAxis{joint, 0, axis}), Status::ok);
  }
};

TEST(JointDrives, HingeStopsAtItsLimits) {
  Lever lever;
  lever.set({.mode = AxisMode::limited, .lower = -0.5_rad, .upper = 0.5_rad});
  test::step(lever.world, 240);
  EXPECT_NEAR(lever.angle(), -0.5, 1e-3);
  const JointView view = lever.world.joint(lever.joint);
  EXPECT_NEAR(number(view.torque.x.raw, 20), 40 * 9.81 * 0.5 * std::cos(0.5), 20);
  EXPECT_LT(gap(view), 1e-5);
}

TEST(JointDrives, MotorTurnsAtItsSpeedAndNoStrongerThanItMay) {
  Lever lever;
  lever.set({.speed = 2_rps, .max_effort = Torque::from_integer(1000)});
  test::step(lever.world, 120);
  EXPECT_NEAR(number(lever.world.body(lever.def.body_b).angular_velocity.z.raw, 32), 2, 1e-3);
  Lever weak;
  weak.set({.speed = 2_rps, .max_effort = Torque::from_integer(50)});
  for (int tick = 0; tick < 60; ++tick) {
    (void)weak.world.step();
    ASSERT_LE(std::abs(number(weak.world.joint(weak.joint).torque.x.raw, 20)), 50.001);
  }
}

// A load of 3,200 kg swings from the lever's end.
TEST(JointDrives, MotorTurnsALoadedArmAtItsSpeed) {
  Lever lever;
  BodyDef def = test::dynamic_body(Shape::box(0.2_m, 0.2_m, 0.2_m), 1_m, {}, {});
  def.material.density = Density::from_integer(50'000);
  JointDef hinge = JointDef::of(JointKind::hinge, lever.def.body_b, test::add(lever.world, def));
  hinge.frame_a.orientation = hinge.frame_b.orientation = lever.def.frame_a.orientation;
  hinge.frame_a.position.x = 0.5_m;
  join(lever.world, hinge);
  lever.set({.speed = 2_rps, .max_effort = Torque::from_integer(200'000)});
  test::step(lever.world, 30);
  for (int tick = 0; tick < 300; ++tick) {
    (void)lever.world.step();
    const auto spin = lever.world.body(lever.def.body_b).angular_velocity.z;
    ASSERT_NEAR(number(spin.raw, 32), 2, 2e-3) << "tick " << tick;
  }
}

TEST(JointDrives, MotorBetweenFreeBodiesKeepsTheirAngularMomentum) {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  const Shape bar = Shape::box(0.1_m, 0.5_m, 0.1_m);
  JointDef hinge =
      JointDef::of(JointKind::hinge, test::add(world, test::dynamic_body(bar, {}, {}, {})), {});
  hinge.body_b = test::add(world, test::dynamic_body(bar, 0.2_m, {}, {}));
  hinge.frame_a.position.x = 0.1_m, hinge.frame_b.position.x = -0.1_m;
  hinge.angular[0].speed = 2_rps;
  hinge.angular[0].max_effort = Torque::from_integer(1000);
  join(world, hinge);
  test::step(world, 120);
  const auto spin = [&](BodyHandle body) {
    return number(world.body(body).angular_velocity.x.raw, 32);
  };
  EXPECT_NEAR(spin(hinge.body_a), -1, 1e-3);
  EXPECT_NEAR(spin(hinge.body_b), 1, 1e-3);
}

TEST(JointDrives, SpringSagsAsHookeSays) {
  Lever lever;
  lever.set({.target = 0.25_rad, .hertz = 2_r, .damping_ratio = 1_r});
  test::step(lever.world, 300);
  // k = I·(2πf)² with I of the bar alone, and at rest k·(target − angle) = m·g·l/2·cos(angle)
  const double inertia = 40 * (1 + 0.04) / 12;
  const double torque = inertia * std::pow(2 * M_PI * 2, 2) * (0.25 - lever.angle());
  EXPECT_NEAR(torque / (40 * 9.81 * 0.5 * std::cos(lever.angle())), 1, 0.15);
}

// It swings beyond half a turn, and comes back.
TEST(JointDrives, ASpringTurnsTheShorterWayRound) {
  Lever lever;
  (void)lever.world.apply(SetGravity{{}});
  lever.set({.target = -2.9_rad, .hertz = 2_r, .damping_ratio = 0.3_r});
  test::step(lever.world, 600);
  EXPECT_NEAR(lever.angle(), -2.9, 1e-3);
}

// A ball of 0.2 m on a spring of 1 m, pulled by `pulled` beyond it, without gravity.
struct Swinger {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  JointDef def = JointDef::of(JointKind::distance, add_fixed(world), {});

  Swinger(Number hertz, Number damping_ratio, Position pulled) {
    def.body_b = test::add(world, test::dynamic_body(Shape::sphere(0.2_m), 1_m + pulled, {}, {}));
    def.linear[0].target = 1_m;
    def.linear[0].hertz = hertz;
    def.linear[0].damping_ratio = damping_ratio;
    join(world, def);
  }
  double stretch() { return number(world.body(def.body_b).centre_of_mass.x.raw, 32) - 1; }
};

TEST(JointDrives, AnUndampedSpringKeepsItsAmplitudeAndItsFrequency) {
  for (const int tenths : {3, 20, 97}) {
    const double hertz = tenths / 10.0;
    Swinger swings(Number::from_ratio(tenths, 10), {}, 0.25_m);
    for (int tick = 1; tick <= 600; ++tick) {
      (void)swings.world.step();
      ASSERT_NEAR(swings.stretch(), 0.25 * std::cos(2 * M_PI * hertz * tick / 60), 0.0025)
          << hertz << " Hz, tick " << tick;
    }
  }
}

TEST(JointDrives, ASpringStifferThanTheSubstepResolvesComesToRest) {
  Swinger stiff(60_r, {}, 0.25_m);
  test::step(stiff.world, 60);
  EXPECT_NEAR(stiff.stretch(), 0, 1e-3);
}

TEST(JointDrives, ADampedSpringDecaysAsItShould) {
  Swinger damped(3_r, 0.05_r, 0.25_m);
  const double omega = 2 * M_PI * 3, rate = 0.05 * omega, beat = omega * std::sqrt(1 - 0.0025);
  for (int tick = 1; tick <= 120; ++tick) {
    (void)damped.world.step();
    const double t = tick / 60.0;
    ASSERT_NEAR(
        damped.stretch(),
        0.25 * std::exp(-rate * t) * (std::cos(beat * t) + rate / beat * std::sin(beat * t)), 0.004)
        << "tick " << tick;
  }
}

}  // namespace
}  // namespace lockstone
