#include <array>

#include <gtest/gtest.h>

#include <lockstone/radial_impulse.h>
#include <lockstone/testing/floating.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

struct Yard {
  World world = test::make_world();
  BodyHandle ground = test::add_ground(world);
  BodyHandle near = ball(2_m), far = ball(4_m), outside = ball(8_m);

  BodyHandle ball(Position x) {
    return test::add(world, test::dynamic_body(Shape::sphere(0.5_m), x, 0.5_m, {}));
  }
};

RadialImpulse blast(Falloff falloff) {
  RadialImpulse def;
  def.centre = {{}, 0.5_m, {}};
  def.radius = 5_m;
  def.impulse = 1000_Ns;
  def.falloff = falloff;
  return def;
}

TEST(RadialImpulse, PushesBodiesAwayByTheirDistance) {
  Yard yard;
  std::array<ApplyImpulse, 8> pushes{};
  for (const Falloff falloff : {Falloff::constant, Falloff::linear, Falloff::quadratic}) {
    ASSERT_EQ(radial_impulse(yard.world, blast(falloff), pushes), 2U);
    EXPECT_EQ(pushes[0].body, yard.near);
    EXPECT_EQ(pushes[1].body, yard.far);
    const double expected[][2] = {{1000, 1000}, {700, 300}, {490, 90}};  // surfaces at 1.5 and 3.5
    for (std::size_t i = 0; i < 2; ++i) {
      const double want = expected[static_cast<std::size_t>(falloff)][i];
      EXPECT_NEAR(to_double(pushes[i].impulse.x), want, 0.01);
      EXPECT_NEAR(to_double(pushes[i].impulse.y), 0, 0.01);
      EXPECT_EQ(yard.world.apply(pushes[i]), Status::ok);
    }
  }
  EXPECT_GT(yard.world.velocity(yard.near).x, yard.world.velocity(yard.far).x);
}

TEST(RadialImpulse, SparesBodiesBehindAnObstacle) {
  Yard yard;
  BodyDef wall;
  wall.motion = MotionType::static_body;
  wall.shape = Shape::box(0.1_m, 2_m, 2_m);
  wall.position.x = 3_m;
  wall.filter.category = 4;
  test::add(yard.world, wall);
  std::array<ApplyImpulse, 8> pushes{};
  RadialImpulse def = blast(Falloff::linear);
  EXPECT_EQ(radial_impulse(yard.world, def, pushes), 2U);
  def.obstacle_mask = 4;
  ASSERT_EQ(radial_impulse(yard.world, def, pushes), 1U);
  EXPECT_EQ(pushes[0].body, yard.near);
}

TEST(RadialImpulse, PushesABodyUpwardsThatItIsIn) {
  Yard yard;
  std::array<ApplyImpulse, 1> pushes{};
  RadialImpulse def = blast(Falloff::linear);
  def.centre = yard.world.position(yard.near);
  ASSERT_EQ(radial_impulse(yard.world, def, pushes), 1U);  // as many as there is room for
  EXPECT_EQ(pushes[0].impulse, (Vec3<Impulse>{{}, 1000_Ns, {}}));
  def.filter.ignore = yard.near;
  ASSERT_EQ(radial_impulse(yard.world, def, pushes), 1U);
  EXPECT_EQ(pushes[0].body, yard.far);
}

}  // namespace
}  // namespace lockstone
