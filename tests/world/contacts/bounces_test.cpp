// Bounces of bodies off each other and off immovable ones: at their moment within the tick.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

BodyHandle drop(World& world, const Shape& shape, Position height, Coefficient restitution) {
  BodyDef def = test::dynamic_body(shape, 0_m, height, 0_m);
  def.material.restitution = restitution;
  return test::add(world, def);
}

// The height that a body will rise to, or has fallen from.
double reach(const World& world, BodyHandle body) {
  const double v = to_double(world.velocity(body).y);
  return to_double(world.position(body).y) + v * v / (2 * 9.81);
}

TEST(Bounce, GivesBackItsShareOfTheHeight) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle ball = drop(world, Shape::sphere(0.25_m), 1.25_m, 0.8_r);
  test::step(world, 40);
  EXPECT_NEAR(reach(world, ball), 0.25 + 0.64, 1e-6);
}

TEST(Bounce, WithoutLossKeepsTheHeightForAMinute) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle ball = drop(world, Shape::sphere(0.25_m), 1.25_m, 1_r);
  test::step(world, 3600);
  EXPECT_NEAR(reach(world, ball), 1.25, 1e-6);
}

TEST(Bounce, OfABoxThatLandsFlatIsThatOfABall) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle box = drop(world, Shape::box(0.25_m, 0.25_m, 0.25_m), 1.25_m, 0.5_r);
  test::step(world, 35);
  EXPECT_NEAR(reach(world, box), 0.25 + 0.25, 1e-4);
}

TEST(Bounce, ManyInATickEndInRest) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle ball = drop(world, Shape::sphere(0.25_m), 0.26_m, 0.5_r);
  test::step(world, 30);
  EXPECT_NEAR(to_double(world.position(ball).y), 0.25, 1e-4);
  EXPECT_NEAR(to_double(world.velocity(ball).y), 0, 1e-4);
}

TEST(Bounce, OffARisingPlatformGainsItsSpeedTwice) {
  WorldDef def{.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64};
  def.gravity = {};
  World world = test::make_world(def);
  BodyDef platform;
  platform.motion = MotionType::kinematic;
  platform.shape = Shape::box(2_m, 0.5_m, 2_m);
  platform.velocity = {{}, 1_mps, {}};
  test::add(world, platform);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.25_m), 0_m, 2_m, 0_m);
  ball.material.restitution = 1_r;
  ball.velocity = {{}, -3_mps, {}};
  const BodyHandle handle = test::add(world, ball);
  test::step(world, 60);
  EXPECT_NEAR(to_double(world.velocity(handle).y), 5, 1e-5);
  // They meet after 1.25 m at 4 m/s, 0.3125 s.
  EXPECT_NEAR(to_double(world.position(handle).y), 2 - 3 * 0.3125 + 5 * (1 - 0.3125), 1e-4);
}

TEST(Bounce, BeginsAContactWithItsApproach) {
  World world = test::make_world();
  test::add_ground(world);
  drop(world, Shape::sphere(0.25_m), 1.25_m, 0.8_r);
  int begins = 0;
  for (int tick = 0; tick < 40; ++tick) {
    test::step(world, 1);
    for (const ContactEvent& event : world.events()) {
      if (event.kind != EventKind::contact_begin) continue;
      ++begins;
      EXPECT_NEAR(to_double(event.approach_speed), std::sqrt(2 * 9.81), 1e-4);
    }
  }
  EXPECT_EQ(begins, 1);
}

World weightless() {
  WorldDef def{.body_capacity = 16, .pair_capacity = 128, .contact_capacity = 128};
  def.gravity = {};
  return test::make_world(def);
}

BodyHandle elastic_ball(World& world, Position x, Position y, Velocity speed) {
  BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), x, y, 0_m);
  def.material = {.friction = {}, .restitution = 1_r};
  def.velocity.x = speed;
  return test::add(world, def);
}

TEST(Bounce, PassesAlongARowOfBallsToTheLast) {
  for (const Position gap : {Position{}, Position(0.001_m)}) {
    World world = weightless();
    std::vector<BodyHandle> row;
    for (int i = 0; i < 5; ++i)
      row.push_back(
          elastic_ball(world, (gap + 0.5_m) * i, 0_m, i == 0 ? Velocity(1_mps) : Velocity{}));
    test::step(world, 60);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(world.velocity(row[i]).x, Velocity{});
    EXPECT_EQ(world.velocity(row[4]).x, 1_mps);
  }
}

TEST(Bounce, LeavesTouchingBodiesThatDoNotMeetWithoutASolver) {
  World world = weightless();
  for (int i = 0; i < 5; ++i)
    elastic_ball(world, Position(0.5_m) * i, 0_m, 1_mps);
  for (int tick = 0; tick < 10; ++tick) {
    const StepReport report = world.step();
    EXPECT_EQ(report.contacts, 4U);
    EXPECT_EQ(report.colors, 0U);
    EXPECT_EQ(world.events().size(), tick == 0 ? 4U : 0U);  // they begin to touch, and go on
  }
}

TEST(Bounce, LeavesOverlappingBodiesToTheSolver) {
  World world = weightless();
  for (int i = 0; i < 2; ++i)
    elastic_ball(world, Position(0.4999_m) * i, 0_m, {});
  EXPECT_EQ(world.step().colors, 1U);
}

// The line of centres turns until they touch: the offset is half of both radii, the angle 30°.
TEST(Bounce, OfTwoBallsIsAlongTheirCentresWhereTheyTouch) {
  World world = weightless();
  const BodyHandle moving = elastic_ball(world, -2_m, 0.25_m, 8_mps);
  const BodyHandle still = elastic_ball(world, 0_m, 0_m, {});
  test::step(world, 30);
  const Vec3<Velocity> a = world.velocity(moving), b = world.velocity(still);
  EXPECT_NEAR(to_double(b.x), 8 * 0.75, 1e-7);
  EXPECT_NEAR(to_double(b.y), -8 * 0.75 / std::sqrt(3.0), 1e-7);
  EXPECT_EQ(a.x + b.x, 8_mps);
  EXPECT_EQ(a.y + b.y, Velocity{});
}

TEST(Bounce, OnABallThatRestsPressesItToTheGround) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle lower = drop(world, Shape::sphere(0.25_m), 0.25_m, 0.5_r);
  test::step(world, 60);
  const BodyHandle upper = drop(world, Shape::sphere(0.25_m), 1.5_m, 0.5_r);
  test::step(world, 240);
  EXPECT_NEAR(to_double(world.position(lower).y), 0.25, 1e-3);
  EXPECT_GT(to_double(world.position(upper).y), 0.249);
}

// Of a body without forces but gravity, J/kg.
double energy_of(const World& world, BodyHandle body, double i_x, double i_yz) {
  const BodyView view = world.body(body);
  const auto w = view.angular_velocity;
  const Mat3 turn = to_matrix(view.orientation);
  const auto about = [&](int axis) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += to_double(turn.column(axis)[i]) * to_double(w[i]);
    return sum;
  };
  double moving = 9.81 * to_double(view.centre_of_mass.y);
  for (int i = 0; i < 3; ++i)
    moving += 0.5 * to_double(view.velocity[i]) * to_double(view.velocity[i]);
  return moving +
         0.5 * (i_x * about(0) * about(0) + i_yz * (about(1) * about(1) + about(2) * about(2)));
}

TEST(Bounce, OfARodThatTumblesNeverGains) {
  // m·(a² + b²)/3 for half extents a, b
  const double i_x = (0.01 + 0.01) / 3, i_yz = (0.36 + 0.01) / 3;
  for (int seed = 0; seed < 40; ++seed) {
    World world = test::make_world();
    test::add_ground(world);
    BodyDef def = test::dynamic_body(Shape::box(0.6_m, 0.1_m, 0.1_m), 0_m, 3_m, 0_m);
    def.material.restitution = 1_r;
    def.material.friction = Coefficient::from_ratio(seed % 6, 10);
    def.orientation =
        from_axis_angle({0.6_r, {}, 0.8_r}, Angle::from_ratio(seed * 17 % 61 - 30, 20));
    def.angular_velocity = {1_rps, AngularVelocity::from_integer(seed % 7 - 3), 2_rps};
    const BodyHandle rod = test::add(world, def);
    double least = energy_of(world, rod, i_x, i_yz);
    const double first = least;
    for (int tick = 0; tick < 480; ++tick) {
      (void)world.step();
      const double now = energy_of(world, rod, i_x, i_yz);
      ASSERT_LT(now - least, 0.02 * first) << "seed " << seed << ", tick " << tick;
      least = std::min(least, now);
    }
  }
}

// Balls of 0.2 m, each on two rods of 2 m; the first `lifted` of them out by 0.7 rad.
struct Cradle {
  World world = test::make_world();
  std::vector<BodyHandle> balls;

  Cradle(int count, int lifted) {
    for (int i = 0; i < count; ++i) {
      const double turn = i < lifted ? -0.7 : 0;
      const auto place = [](double x) {
        return Position::from_raw(std::llround(std::ldexp(x, 32)));
      };
      BodyDef def = test::dynamic_body(Shape::sphere(0.2_m), place(0.4002 * i + 2 * std::sin(turn)),
                                       place(-2 * std::cos(turn)), {});
      def.material.restitution = 1_r;
      def.material.friction = {};
      balls.push_back(test::add(world, def));
      for (const int side : {-1, 1}) {
        BodyDef hook;
        hook.motion = MotionType::static_body;
        hook.shape = Shape::sphere(0.01_m);
        hook.position = {place(0.4002 * i), {}, Position::from_integer(side)};
        JointDef rod = JointDef::of(JointKind::distance, test::add(world, hook), balls.back());
        rod.linear[0].mode = AxisMode::limited;
        rod.linear[0].lower = rod.linear[0].upper = Length::from_raw(2344686);  // √5 m
        (void)world.create_joint(rod).value();
      }
    }
  }
  [[nodiscard]] double energy() const {
    double sum = 0;
    for (const BodyHandle ball : balls) {
      const auto v = world.velocity(ball);
      sum += 9.81 * (to_double(world.position(ball).y) + 2);
      for (int i = 0; i < 3; ++i)
        sum += 0.5 * to_double(v[i]) * to_double(v[i]);
    }
    return sum;
  }
};

TEST(Bounce, OfACradleKeepsItsEnergyForTenSeconds) {
  for (const auto& [count, lifted] :
       {std::pair{2, 1}, std::pair{3, 1}, std::pair{5, 2}, std::pair{7, 3}}) {
    Cradle cradle(count, lifted);
    const double first = cradle.energy();
    test::step(cradle.world, 600);
    EXPECT_NEAR(cradle.energy() / first, 1, 0.03) << count << " balls, " << lifted << " lifted";
  }
}

TEST(Bounce, OfACradlePassesAlongToItsLastBall) {
  Cradle cradle(5, 1);
  test::step(cradle.world, 60);  // after the first impact
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(to_double(cradle.world.velocity(cradle.balls[static_cast<std::size_t>(i)]).x), 0,
                0.1);
  EXPECT_GT(to_double(cradle.world.velocity(cradle.balls[4]).x), 2);
}

}  // namespace
}  // namespace lockstone
