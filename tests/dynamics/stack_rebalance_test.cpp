// Stack rebalance: a high wall stands, and no moving body is slowed.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/stack/motion_balance.h"
#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

// Nothing sleeps.
World heap_world() {
  return test::make_world(
      {.body_capacity = 1024, .pair_capacity = 16384, .contact_capacity = 8192, .sleep_ms = 0});
}

// Bricks of 1 m, 0.1 m apart, each on two below it; row r is off along z by r² · bend.
std::vector<BodyHandle> add_wall(World& world, int rows, Position bend = {}) {
  std::vector<BodyHandle> bricks;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      const BodyDef brick = test::dynamic_body(
          Shape::box(0.5_m, 0.5_m, 0.5_m), Position::from_ratio(22 * i + 11 * row, 20),
          Position::from_ratio(2 * row + 1, 2), bend * (row * row));
      bricks.push_back(test::add(world, brick));
    }
  }
  return bricks;
}

BodyHandle add_moving(World& world, const Shape& shape, Position z, Velocity speed,
                      Coefficient friction) {
  BodyDef def = test::dynamic_body(shape, -10_m, 0.5_m, z);
  def.velocity.x = speed;
  def.material.friction = friction;
  return test::add(world, def);
}

// Half a millimetre at the top; by iterations alone it has grown by 2 mm after five seconds.
TEST(StackRebalance, KeepsAWallFromBendingOn) {
  World world = heap_world();
  test::add_ground(world);
  const std::vector<BodyHandle> bricks = add_wall(world, 40, Position::from_ratio(1, 3'200'000));
  std::vector<Vec3<Position>> start;
  for (const BodyHandle brick : bricks)
    start.push_back(world.position(brick));
  test::step(world, 300);
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(metres(world.position(bricks[i])[axis]), metres(start[i][axis]), 1e-4) << i;
  }
}

// Rigid contacts alone keep it rattling at 0.14 m/s.
TEST(StackRebalance, LetsABlockOfBoxesComeToRest) {
  World world = heap_world();
  test::add_ground(world);
  test::Random random(22);
  std::vector<BodyHandle> boxes;
  const auto off = [&] { return Position::from_ratio(random.between(-20, 20), 1000); };
  for (int i = 0; i < 216; ++i) {
    const auto place = [](int k) { return Position::from_ratio(11 * k, 10); };
    const Position x = place(i % 6) + off(), z = place(i / 6 % 6) + off();
    boxes.push_back(test::add(
        world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), x, place(i / 36) + 1.5_m, z)));
  }
  test::step(world, 1200);
  for (const BodyHandle box : boxes) {
    const Vec3<Velocity> v = world.velocity(box);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LT(std::abs(metres_per_second(v[axis])), 1e-3);
  }
}

TEST(StackRebalance, BrakesNothingThatRollsOrSlides) {
  World world = heap_world();
  test::add_ground(world);
  add_wall(world, 22);
  const Velocity speed = Velocity::from_ratio(1, 500);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.5_m), -10_m, 0.5_m, 2_m);
  ball.velocity.x = speed;
  ball.angular_velocity.z = -AngularVelocity::from_ratio(1, 250);
  const BodyHandle rolls = test::add(world, ball);
  const BodyHandle slides =
      add_moving(world, Shape::box(0.5_m, 0.5_m, 0.5_m), 4_m, speed, Coefficient{});
  test::step(world, 150);
  for (const BodyHandle body : {rolls, slides})
    EXPECT_NEAR(metres_per_second(world.velocity(body).x), 2e-3, 4e-6);
}

TEST(StackRebalance, BrakesNoWallThatIsCarried) {
  World world = heap_world();
  BodyDef platform;
  platform.motion = MotionType::kinematic;
  platform.shape = Shape::box(50_m, 1_m, 50_m);
  platform.position = {{}, -1_m, {}};
  platform.velocity.x = Velocity::from_ratio(1, 500);
  test::add(world, platform);
  const std::vector<BodyHandle> bricks = add_wall(world, 22);
  test::step(world, 120);
  const double before = metres(world.position(bricks.back()).x);
  test::step(world, 60);
  EXPECT_NEAR(metres(world.position(bricks.back()).x) - before, 2e-3, 1e-4);
}

TEST(MotionBalance, FindsImpulsesThatChangeAMotion) {
  test::Random random;
  int solved = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<Motion6> columns(12);
    MotionBalance all;
    for (Motion6& column : columns) {
      for (std::int64_t& part : column)
        part = random.between(-(1 << 26), 1 << 26);
      all.add(column);
    }
    Motion6 change{};
    for (std::int64_t& part : change)
      part = random.between(-(1 << 29), 1 << 29);
    all.factor();
    Motion6 solution{};
    if (!all.solve(change, solution)) continue;  // hardly ever: rows are too much alike
    ++solved;
    std::array<double, 6> sum{};
    for (const Motion6& column : columns) {
      const double impulse = static_cast<double>(MotionBalance::impulse(column, solution));
      for (std::size_t i = 0; i < 6; ++i)
        sum[i] += impulse * std::ldexp(static_cast<double>(column[i]), -26);
    }
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(sum[i], static_cast<double>(change[i]), 1 << 18);
  }
  EXPECT_GT(solved, 900);
}

// A row along x alone stops motion along x, and leaves the rest.
TEST(MotionBalance, LeavesOutMotionThatNoRowChanges) {
  MotionBalance all;
  const Motion6 column{1 << 26, 0, 0, 0, 0, 0};
  all.add(column);
  all.factor();
  Motion6 solution{};
  EXPECT_TRUE(all.solve({5000, 6000, 0, 0, 0, 7000}, solution));
  EXPECT_EQ(solution, (Motion6{5000, 0, 0, 0, 0, 0}));
  EXPECT_EQ(MotionBalance::impulse(column, solution), 5000);
}

}  // namespace
}  // namespace lockstone
