// Ropes and drags: settings of joints that have helpers.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <lockstone/drag.h>

#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres, test::number;

// A ball of 10 kg at the origin, without gravity, and a ground that is turned and far away.
struct Dragged {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  Drag drag;
  JointHandle joint;

  explicit Dragged(Number hertz, Number damping_ratio, Force max_force = {}) {
    BodyDef ground;
    ground.motion = MotionType::static_body;
    ground.position = {300_m, 20_m, -100_m};
    ground.orientation = from_axis_angle({{}, Unit::from_integer(1), {}}, 0.7_rad);
    BodyDef ball = test::dynamic_body(Shape::sphere(0.2_m), {}, {}, {});
    ball.mass.mass = Mass::from_integer(10);
    drag = {.ground = test::add(world, ground),
            .body = test::add(world, ball),
            .hertz = hertz,
            .damping_ratio = damping_ratio,
            .max_force = max_force};
    joint = world.create_joint(drag_joint(world, drag, {})).value();
  }
  void pull_to(const Vec3<Position>& target) {
    for (const SetLinearAxis& command : drag_commands(world, joint, drag, target))
      ASSERT_EQ(world.apply(command), Status::ok);
  }
  double x() { return metres(world.position(drag.body).x); }
};

TEST(Drags, SwingAtTheirFrequency) {
  for (const int hertz : {1, 3}) {
    Dragged ball(Number::from_integer(hertz), {});
    ball.pull_to({0.5_m, {}, {}});
    double worst = 0;
    for (int tick = 1; tick <= 240; ++tick) {
      (void)ball.world.step();
      worst =
          std::max(worst, std::abs(ball.x() - 0.5 * (1 - std::cos(2 * M_PI * hertz * tick / 60))));
    }
    std::printf("swings at %d Hz within %.2g m\n", hertz, worst);
    EXPECT_LT(worst, 0.005);
  }
}

TEST(Drags, ComeToTheTargetAndFollowIt) {
  Dragged ball(5_r, 1_r);
  ball.pull_to({2_m, -1_m, 0.5_m});
  test::step(ball.world, 120);
  const Vec3<Position> at = ball.world.position(ball.drag.body);
  EXPECT_NEAR(metres(at.x), 2, 1e-4);
  EXPECT_NEAR(metres(at.y), -1, 1e-4);
  EXPECT_NEAR(metres(at.z), 0.5, 1e-4);
}

// s = F·t²/2m along an axis of the ground, while the target is far.
TEST(Drags, PullNoHarderThanTheyMay) {
  Dragged ball(5_r, {}, Force::from_integer(20));
  const Vec3<Unit> axis = to_matrix(pose_of(ball.world, ball.drag.ground).orientation).x;
  ball.pull_to(
      {rounded<Position>(axis.x * Length(100_m)), {}, rounded<Position>(axis.z * Length(100_m))});
  test::step(ball.world, 60);
  const Vec3<Position> at = ball.world.position(ball.drag.body);
  EXPECT_NEAR(std::hypot(metres(at.x), metres(at.z)), 0.5 * 20 / 10, 0.02);
}

TEST(Drags, AreRefusedWithoutASpringThatIsValid) {
  Dragged ball(5_r, 1_r);
  ball.drag.hertz = 1001_r;
  EXPECT_EQ(ball.world.create_joint(drag_joint(ball.world, ball.drag, {})).status(),
            Status::invalid_argument);
  const auto commands = drag_commands(ball.world, ball.joint, ball.drag, {});
  EXPECT_EQ(ball.world.apply(commands[1]), Status::invalid_argument);
}

// A ball falls free until its rope is taut, and then hangs at its length.
TEST(Ropes, LimitTheGreatestDistanceAlone) {
  World world = test::make_world({.body_capacity = 4});
  const BodyHandle hook = test::add_fixed(world);
  const BodyHandle ball =
      test::add(world, test::dynamic_body(Shape::sphere(0.1_m), {}, -0.5_m, {}));
  (void)test::join(world, JointDef::rope(hook, ball, 2_m));
  test::step(world, 20);
  // 1/3 s of free fall
  EXPECT_NEAR(metres(world.position(ball).y), -0.5 - 0.5 * 9.81 / 9, 1e-3);
  double lowest = 0;
  for (int tick = 0; tick < 300; ++tick) {
    (void)world.step();
    lowest = std::min(lowest, metres(world.position(ball).y));
  }
  EXPECT_GT(lowest, -2.001);
  EXPECT_NEAR(metres(world.position(ball).y), -2, 1e-3);
}

}  // namespace
}  // namespace lockstone
