// The initial warm start of contacts: the impulses of the contacts before them, or the weight above
// them.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/contact/contact_prepare.h"
#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

// Bricks of 1 m in `rows` rows, each on two below it and this much before them; of random
// densities, or all alike.
std::vector<BodyHandle> add_wall(World& world, int rows, test::Random* random, Position lean = {}) {
  std::vector<BodyHandle> bricks;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      BodyDef brick =
          test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), Position::from_ratio(2 * i + row, 2),
                             Position::from_ratio(2 * row + 1, 2), lean * row);
      if (random != nullptr)
        brick.material.density = Density::from_integer(static_cast<int>(random->between(300, 900)));
      bricks.push_back(test::add(world, brick));
    }
  }
  return bricks;
}

double fastest(const World& world, const std::vector<BodyHandle>& bodies) {
  double most = 0;
  for (const BodyHandle body : bodies) {
    const Vec3<Velocity> v = world.velocity(body);
    for (int i = 0; i < 3; ++i)
      most = std::max(most, std::abs(metres_per_second(v[i])));
  }
  return most;
}

// By iterations alone it is off by up to 22 mm after a second.
TEST(InitialWarmStart, HoldsAWallFromItsFirstTick) {
  World world = test::make_world();
  test::add_ground(world);
  const std::vector<BodyHandle> bricks = add_wall(world, 22, nullptr);
  std::vector<Vec3<Position>> start;
  for (const BodyHandle brick : bricks)
    start.push_back(world.position(brick));
  test::step(world, 1);
  EXPECT_LT(fastest(world, bricks), 1e-3);  // gravity gives 0.16 m/s
  test::step(world, 59);
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(metres(world.position(bricks[i])[axis]), metres(start[i][axis]), 2e-4) << i;
  }
}

TEST(InitialWarmStart, HoldsWallsOfUnlikeBricks) {
  test::Random random;
  for (int i = 0; i < 4; ++i) {
    World world = test::make_world();
    test::add_ground(world);
    const std::vector<BodyHandle> bricks = add_wall(world, 16, &random);
    test::step(world, 1);
    EXPECT_LT(fastest(world, bricks), 1e-2);
  }
}

// They converge, and settle by 5 µm a contact. From nothing the highest would have 0.9 mm/s left.
TEST(InitialWarmStart, HoldsWallsThatConverge) {
  test::Random random;
  for (int rows = 2; rows <= 10; ++rows) {
    World world = test::make_world();
    test::add_ground(world);
    const std::vector<BodyHandle> bricks = add_wall(world, rows, &random);
    const Position before = world.position(bricks.back()).y;
    test::step(world, 1);
    EXPECT_LT(fastest(world, bricks), 1e-5) << rows;
    EXPECT_NEAR(metres(world.position(bricks.back()).y), metres(before) - 5.2e-6 * rows,
                1e-6 * rows)
        << rows;
  }
}

// Nothing is under it: it falls as one.
TEST(InitialWarmStart, HoldsNothingInTheAir) {
  World world = test::make_world();
  const std::vector<BodyHandle> bricks = add_wall(world, 16, nullptr);
  test::step(world, 60);
  for (const BodyHandle brick : bricks)
    EXPECT_NEAR(metres_per_second(world.velocity(brick).y), -9.81, 1e-3);
}

// A brick that tips over its supports pushes them harder than its weight, and so on from row to
// row.
TEST(InitialWarmStart, ThrowsNothingOffAWallThatLeans) {
  World world = test::make_world();
  test::add_ground(world);
  const std::vector<BodyHandle> bricks = add_wall(world, 22, nullptr, Position::from_ratio(2, 5));
  for (int tick = 1; tick <= 30; ++tick) {
    test::step(world, 1);
    EXPECT_LT(fastest(world, bricks), 1 + 9.81 * tick / 60);  // free fall, and rolling off
  }
}

TEST(ContactPoints, ThatAreNewShareTheImpulsesOfVanishedOnes) {
  Manifold manifold;
  manifold.count = 4;
  for (std::uint32_t i = 0; i < 4; ++i)
    manifold.points[i].feature = 10 + i;
  ContactRecord record;
  record.count = 4;
  const std::uint32_t features[] = {11, 10, 20, 21};
  for (std::size_t i = 0; i < 4; ++i)
    record.points[i] = {features[i], SolverVelocity::from_raw(100 << i)};
  const SolverBody body;
  const ContactSurface surface;
  const auto impulses = [&] {
    lanes::PrepareInput source;
    (void)fill_source({body, body, manifold, record, surface}, ContactSoftness{}, source);
    return source.impulses;
  };
  EXPECT_EQ(impulses(), (std::array<std::int32_t, 4>{200, 100, 600, 600}));
  manifold.points[2].feature = 20;
  EXPECT_EQ(impulses(), (std::array<std::int32_t, 4>{200, 100, 400, 800}));
  manifold.count = 2;
  EXPECT_EQ(impulses(), (std::array<std::int32_t, 4>{200, 100, 0, 0}));
}

}  // namespace
}  // namespace lockstone
