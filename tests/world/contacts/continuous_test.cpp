// Continuous collision: nothing fast passes through anything.
#include <algorithm>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

BodyDef wall(Length half_thickness) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = Shape::box(half_thickness, 20_m, 20_m);
  return def;
}

// Twice, of a kilogram of a needle of 2 m × 2 cm along y; its least moment is 1/4096 m² and the
// square of its scale of 2 m.
double needle_energy(const BodyView& view) {
  const auto square = [](double x) { return x * x; };
  const Vec3<Unit> axis = to_matrix(view.orientation).y;
  double linear = 0, turning = 0, axial = 0;
  for (int i = 0; i < 3; ++i) {
    const double w = testing::to_double(view.angular_velocity[i]);
    linear += square(testing::to_double(view.velocity[i]));
    turning += square(w);
    axial += w * testing::to_double(axis[i]);
  }
  constexpr double k_across = 0.3422, k_along = 4.0 / 4096;
  return linear + k_across * (turning - square(axial)) + k_along * square(axial);
}

World space_for_bullets() {
  return test::make_world({.body_capacity = 16, .gravity = {}});
}

// Centimetre walls, bullets of a few centimetres at up to 500 m/s, from anywhere, at any angle.
TEST(Continuous, NoBulletPassesAWallOfOneCentimetre) {
  test::Random random(test::run_seed());
  int impacts = 0;
  for (int run = 0; run < test::share_of(2000); ++run) {
    World world = space_for_bullets();
    test::add(world, wall(0.005_m));
    const Length size =
        Length::from_raw(static_cast<std::int32_t>(random.between(1 << 14, 1 << 16)));
    const auto kind = random.between(0, 2);
    const Shape shape = kind == 0   ? Shape::sphere(size)
                        : kind == 1 ? Shape::capsule(size, size)
                                    : Shape::box(size, size, size);
    BodyDef def = test::dynamic_body(shape, {}, {}, {});
    def.position.x.raw = -random.between(std::int64_t{1} << 30, std::int64_t{20} << 32);
    def.velocity.x.raw = random.between(std::int64_t{20} << 32, std::int64_t{400} << 32);
    def.velocity.y.raw = random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    def.angular_velocity.z.raw =
        random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    def.material.restitution.raw = static_cast<std::int32_t>(random.between(0, 1 << 30));
    const BodyHandle bullet = test::add(world, def);
    for (int tick = 0; tick < 30; ++tick) {
      impacts += static_cast<int>(world.step().impacts);
      const BodyView view = world.body(bullet);
      const bool beyond_the_rim = metres(abs(view.position.y)) > 19;
      if (beyond_the_rim) break;
      ASSERT_LT(metres(view.position.x), 0.0)
          << "run " << run << " tick " << tick << " kind " << kind << " size " << size.raw
          << " start " << def.position.x.raw << " velocity " << def.velocity.x.raw << ", "
          << def.velocity.y.raw << " spin " << def.angular_velocity.z.raw;
    }
  }
  EXPECT_GT(impacts, test::share_of(1000));
}

TEST(Continuous, ABouncingBallKeepsTheRestOfTheTick) {
  World world = space_for_bullets();
  test::add(world, wall(0.05_m));
  BodyDef def = test::dynamic_body(Shape::sphere(0.1_m), -10_m, {}, {});
  def.velocity = {300_mps, {}, {}};
  def.material.restitution = 1_r;
  const BodyHandle ball = test::add(world, def);
  test::step(world, 6);  // 30 m: 9.85 to the wall and 20.15 back
  EXPECT_NEAR(metres(world.position(ball).x), -0.15 - 20.15, 0.05);
  EXPECT_NEAR(metres(Position::from_raw(world.velocity(ball).x.raw)), -300, 1e-3);
}

TEST(Continuous, ASpinningRodDoesNotReachThroughAWall) {
  test::Random random(test::run_seed());
  for (int run = 0; run < test::share_of(300); ++run) {
    World world = space_for_bullets();
    test::add(world, wall(0.01_m));
    BodyDef def = test::dynamic_body(Shape::capsule(1_m, 0.02_m), -1.1_m, {}, {});
    def.angular_velocity.z.raw = random.between(std::int64_t{20} << 32, std::int64_t{150} << 32);
    def.velocity.x.raw = random.between(std::int64_t{0}, std::int64_t{60} << 32);
    const BodyHandle rod = test::add(world, def);
    for (int tick = 0; tick < 60; ++tick) {
      (void)world.step();
      ASSERT_LT(metres(world.body(rod).centre_of_mass.x), 0.0) << "run " << run;
    }
  }
}

// Thinner than a tick's turn: more than half a turn a tick, tips that stay in the wall, impacts
// that leave a needle with any momentum about its axis.
TEST(Continuous, AFastThinRodDoesNotPassAWallOfOneCentimetre) {
  test::Random random(test::run_seed());
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return random.between(low << 32, high << 32);
  };
  for (int run = 0; run < test::share_of(300); ++run) {
    World world = space_for_bullets();
    test::add(world, wall(0.005_m));
    const Length thin =
        Length::from_raw(static_cast<std::int32_t>(random.between(5 << 10, 30 << 10)));
    const Shape shape = run % 2 == 0 ? Shape::capsule(1_m, thin) : Shape::box(thin, 1_m, thin);
    BodyDef def = test::dynamic_body(shape, -1.3_m, {}, {});
    def.velocity.x.raw = between(0, 100);
    def.velocity.y.raw = between(-20, 20);
    def.angular_velocity.x.raw = between(-30, 30);
    def.angular_velocity.y.raw = between(-140, 140);
    def.angular_velocity.z.raw = between(-140, 140);
    const BodyHandle rod = test::add(world, def);
    for (int tick = 0; tick < 20; ++tick) {
      (void)world.step();
      ASSERT_LT(metres(world.body(rod).centre_of_mass.x), 0.0) << "run " << run;
    }
  }
}

// An impact against something at rest gives no energy, whatever the body turns by until then.
TEST(Continuous, AnImpactGivesANeedleNoEnergy) {
  test::Random random(test::run_seed());
  for (int run = 0; run < test::share_of(100); ++run) {
    World world = space_for_bullets();
    test::add(world, wall(0.05_m));
    BodyDef def = test::dynamic_body(Shape::capsule(1_m, 0.01_m), -1.4_m, {}, {});
    def.material.friction = {};
    def.velocity.x = 60_mps;
    def.angular_velocity.y.raw = random.between(-(std::int64_t{60} << 32), std::int64_t{60} << 32);
    def.angular_velocity.z.raw = random.between(-(std::int64_t{60} << 32), std::int64_t{60} << 32);
    const BodyHandle needle = test::add(world, def);
    const double before = needle_energy(world.body(needle));
    for (int tick = 0; tick < 5; ++tick) {
      (void)world.step();
      ASSERT_LT(needle_energy(world.body(needle)), 1.01 * before) << "run " << run;
    }
  }
}

TEST(Continuous, OnlyBulletsAreStoppedByDynamicBodies) {
  for (const bool bullet : {false, true}) {
    World world = space_for_bullets();
    BodyDef plate = test::dynamic_body(Shape::box(0.01_m, 2_m, 2_m), 4_m, {}, {});
    const BodyHandle target = test::add(world, plate);
    BodyDef def = test::dynamic_body(Shape::sphere(0.05_m), {}, {}, {});
    def.velocity = {450_mps, {}, {}};
    def.is_bullet = bullet;
    const BodyHandle ball = test::add(world, def);
    int impacts = 0;
    for (int tick = 0; tick < 4; ++tick) {
      (void)world.step();
      impacts += static_cast<int>(
          std::ranges::count(world.events(), EventKind::impact, &ContactEvent::kind));
    }
    EXPECT_EQ(impacts > 0, bullet);
    EXPECT_EQ(world.velocity(target).x > Velocity{}, bullet);
    EXPECT_EQ(world.position(ball).x > 6_m, !bullet);
  }
}

TEST(Continuous, SlowAndRollingBodiesAreNotSwept) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
  def.velocity = {12_mps, {}, {}};  // 0.2 m a tick, less than a quarter of a metre
  test::add(world, def);
  for (int tick = 0; tick < 60; ++tick) {
    const StepReport report = world.step();
    ASSERT_EQ(report.continuous_bodies, 0U);
    ASSERT_EQ(report.impacts, 0U);
  }
}

TEST(Continuous, SlidingFastIsNoImpact) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::box(0.25_m, 0.25_m, 0.25_m), -40_m, 0.25_m, {});
  def.velocity = {80_mps, {}, {}};
  def.material.friction = {};
  const BodyHandle box = test::add(world, def);
  for (int tick = 0; tick < 45; ++tick) {
    const StepReport report = world.step();
    ASSERT_EQ(report.continuous_bodies, 1U);
    ASSERT_EQ(report.impacts, 0U) << "tick " << tick;
  }
  EXPECT_NEAR(metres(world.position(box).x), 20, 1e-3);
}

// A half-space has its body somewhere, but no end. It leans, so that its own axes count.
TEST(Continuous, AHalfSpaceStopsBulletsFarFromItsBody) {
  for (const std::int64_t far : {0, 900, 1900, 20'000, 300'000}) {
    World world = space_for_bullets();
    BodyDef slope;
    slope.motion = MotionType::static_body;
    slope.shape = Shape::half_space();
    slope.orientation = {Unit::from_ratio(3, 5), {}, {}, Unit::from_ratio(4, 5)};
    test::add(world, slope);
    const Mat3 axes = to_matrix(slope.orientation);
    BodyDef ball = test::dynamic_body(Shape::sphere(0.05_m), {}, {}, {});
    for (int i = 0; i < 3; ++i) {  // 5 m above it, falling at 300 m/s
      const std::int64_t up = axes.column(1)[i].raw * std::int64_t{4};
      const std::int64_t along = axes.column(2)[i].raw * std::int64_t{4};
      ball.position[i].raw = far * along + 5 * up;
      ball.velocity[i].raw = -300 * up;
    }
    const BodyHandle bullet = test::add(world, ball);
    test::step(world, 10);
    double height = 0;
    for (int i = 0; i < 3; ++i)
      height += metres(world.position(bullet)[i]) * testing::to_double(axes.column(1)[i]);
    EXPECT_NEAR(height, 0.05, 0.01) << far << " m";
  }
}

// Nor does it collide with a body so high above it, or so deep below, that their distance fits no
// length.
TEST(Continuous, AHalfSpaceIsNoMatterKilometresAway) {
  for (const int height : {-300'000, -4000, 1500, 4000, 300'000}) {
    World world = space_for_bullets();
    BodyDef ground;
    ground.motion = MotionType::static_body;
    ground.shape = Shape::half_space();
    test::add(world, ground);
    BodyDef ball =
        test::dynamic_body(Shape::sphere(0.05_m), {}, Position::from_integer(height), {});
    ball.velocity.x = Velocity::from_integer(300);
    ball.velocity.y = Velocity::from_integer(height > 0 ? -100 : 100);
    test::add(world, ball);
    for (int tick = 0; tick < 10; ++tick)
      ASSERT_EQ(world.step().impacts, 0U) << height << " m";
  }
}

TEST(Continuous, KeepsBodiesInTheWorldAfterAnImpact) {
  World world = space_for_bullets();
  BodyDef def = wall(0.5_m);
  def.position = {k_world_limit - 4_m, {}, {}};
  test::add(world, def);
  BodyDef bullet = test::dynamic_body(Shape::sphere(0.05_m), {}, {}, {});
  bullet.position = {k_world_limit - 2_m, {}, {}};
  bullet.velocity.x = -400_mps;
  bullet.material.restitution = 1_r;
  const BodyHandle body = test::add(world, bullet);
  for (int tick = 0; tick < 3; ++tick) {
    world.step();
    EXPECT_LE(world.position(body).x, k_world_limit);
  }
  EXPECT_EQ(world.position(body).x, k_world_limit);
}

// Two limbs that fall on a thin floor; returns how often one of them met it within a tick.
std::uint32_t impacts_of_limbs_from(Position height) {
  World world = test::make_world();
  BodyDef floor;
  floor.motion = MotionType::static_body;
  floor.shape = Shape::box(5_m, 0.02_m, 5_m);
  floor.position.y = Position::from_ratio(-1, 50);
  test::add(world, floor);
  const auto limb = [&](const Shape& shape, Position y) {
    BodyDef def = test::dynamic_body(shape, {}, y, {});
    def.velocity.y = -40_mps;
    return test::add(world, def);
  };
  JointDef hip =
      JointDef::of(JointKind::ball, limb(Shape::box(0.2_m, 0.3_m, 0.2_m), height),
                   limb(Shape::box(0.07_m, 0.2_m, 0.07_m), height - Position::from_ratio(1, 2)));
  hip.frame_a.position.y = -0.3_m;
  hip.frame_b.position.y = 0.2_m;
  const JointHandle joint = world.create_joint(hip).value();
  std::uint32_t impacts = 0;
  for (int tick = 0; tick < 60; ++tick) {
    impacts += world.step().impacts;
    const Vec3<Length> gap = world.joint(joint).offset;
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(testing::to_double(gap[i]), 0, 1e-3) << "tick " << tick;
    EXPECT_LT(testing::to_double(world.body(hip.body_a).velocity.y), 10) << "tick " << tick;
  }
  return impacts;
}

// A limb alone stopped 11 cm and more before its joint, which then threw both up at 18 m/s.
TEST(Continuous, JoinedBodiesStopTogether) {
  std::uint32_t impacts = 0;
  for (int i = 0; i < 20; ++i)
    impacts += impacts_of_limbs_from(Position::from_ratio(200 + 3 * i, 100));
  EXPECT_GT(impacts, 0U);
}

}  // namespace
}  // namespace lockstone
