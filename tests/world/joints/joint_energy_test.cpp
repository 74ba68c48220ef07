// Joints give bodies no energy, however fast these turn.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

// A thin bar on a long lever of a heavy cube, both turning about axes of their own, without
// gravity: rad/s for each component at most `spin`.
struct Whirl {
  World world = make();
  BodyHandle cube, bar;
  std::uint32_t limits = 0;

  Whirl(JointKind kind, std::uint64_t seed, int spin) {
    test::Random random(seed);
    const auto tenths = [&] { return Length::from_ratio(random.between(-3, 3), 10); };
    const auto turn = [&] {
      return AngularVelocity::from_ratio(random.between(-100 * spin, 100 * spin), 100);
    };
    const Vec3<Length> at = {0.4_m, tenths(), tenths()};
    const auto add = [&](const Shape& shape, Position x) {
      BodyDef def = test::dynamic_body(shape, x, {}, {});
      def.angular_velocity = {turn(), turn(), turn()};
      def.material.density = 1000_kgpm3;
      return test::add(world, def);
    };
    cube = add(Shape::box(0.2_m, 0.2_m, 0.2_m), {});
    bar = add(Shape::box(0.15_m, 0.04_m, 0.03_m), 1_m);
    JointDef def = JointDef::of(kind, cube, bar);
    def.frame_a.position = at;
    def.frame_b.position = {at.x - 1_m, at.y, at.z};
    (void)test::join(world, def);
  }
  static World make() {
    WorldDef def{.body_capacity = 4, .pair_capacity = 16, .contact_capacity = 16};
    def.joint_capacity = 4;
    def.gravity = {};
    return test::make_world(def);
  }
  // Of both, J; about the principal axes of a box of half extents x, y, z.
  static double energy_of(const BodyView& view, double x, double y, double z) {
    const Mat3 turned = to_matrix(view.orientation);
    const double moments[] = {(y * y + z * z) / 3, (x * x + z * z) / 3, (x * x + y * y) / 3};
    double twice = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double about = 0;
      for (int i = 0; i < 3; ++i)
        about += to_double(turned.column(axis)[i]) * to_double(view.angular_velocity[i]);
      twice += std::pow(to_double(view.velocity[axis]), 2) + moments[axis] * about * about;
    }
    return 4000 * x * y * z * twice;
  }
  double energy() const {
    return energy_of(world.body(cube), 0.2, 0.2, 0.2) +
           energy_of(world.body(bar), 0.15, 0.04, 0.03);
  }
  // The most energy that is regained in two seconds, as a part of the first.
  double gain() {
    const double first = energy();
    double least = first, gain = 0;
    for (int tick = 0; tick < 120; ++tick) {
      limits += world.step().energy_limits;
      gain = std::max(gain, (energy() - least) / first);
      least = std::min(least, energy());
    }
    return gain;
  }
};

TEST(JointEnergy, OfBarsThatWhirlOnLeversIsNeverGained) {
  for (const JointKind kind :
       {JointKind::ball, JointKind::hinge, JointKind::slider, JointKind::weld})
    for (std::uint64_t seed = 1; seed <= test::share_of(std::uint64_t{40}); ++seed)
      for (const int spin : {5, 20, 60})
        EXPECT_LT(Whirl(kind, seed, spin).gain(), 0.01)
            << static_cast<int>(kind) << ", seed " << seed << ", " << spin << " rad/s";
}

// A cube on a hinge with limits that are far, without gravity: as fast as its moment says.
TEST(JointEnergy, IsTheWorkOfATorque) {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  JointDef hinge = JointDef::of(JointKind::hinge, test::add_fixed(world), {});
  hinge.body_b = test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, {}, {}));
  hinge.angular[0] = {.mode = AxisMode::limited, .lower = -3_rad, .upper = 3_rad};
  (void)test::join(world, hinge);
  for (int tick = 0; tick < 60; ++tick) {
    ASSERT_EQ(world.apply(ApplyTorque{hinge.body_b, {500_Nm, {}, {}}}), Status::ok);
    (void)world.step();
  }
  const double moment = to_double(world.body(hinge.body_b).mass.mass) / 6;
  EXPECT_NEAR(to_double(world.body(hinge.body_b).angular_velocity.x), 500 / moment, 1e-3);
}

TEST(JointEnergy, IsGivenBackOnlyWhereTheSubstepDoesNotResolveTheTurning) {
  std::uint32_t calm = 0, wild = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Whirl slow(JointKind::weld, seed, 2), fast(JointKind::weld, seed, 60);
    (void)slow.gain();
    (void)fast.gain();
    calm += slow.limits;
    wild += fast.limits;
  }
  EXPECT_EQ(calm, 0U);
  EXPECT_GT(wild, 0U);
}

}  // namespace
}  // namespace lockstone
