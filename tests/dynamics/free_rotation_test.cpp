// Rotation without torque: its invariants, its cost, and its end.
#include "core/dynamics/body/free_rotation.h"

#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "core/dynamics/body/inertia.h"
#include "core/math/rotation_log.h"
#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

BodyRecord body_of(const Vec3<Unit>& inertia, int scale_exponent) {
  BodyRecord body;
  body.motion = static_cast<std::uint8_t>(MotionType::dynamic);
  body.inertia = inertia;
  body.scale_exponent = static_cast<std::int8_t>(scale_exponent);
  body.orientation = {};
  return body;
}

// Twice the energy over the mass and the square of the scale.
double energy(const BodyRecord& body) {
  const Vec3<Velocity> m = rotate_inverse_wide(to_matrix(body.orientation), body.spin);
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    sum += to_double(m[i]) * to_double(m[i]) / to_double(body.inertia[i]);
  return sum;
}

std::uint32_t step(BodyRecord& body, std::int32_t rate) {
  const FreeTurn turn = turn_freely(body, to_matrix(body.orientation), body.spin, {rate});
  body.orientation = turn.orientation;
  return turn.axis_turns;
}

// Above the speed of any turn that it can take, rad/s.
double fastest_turn(const BodyRecord& body) {
  const double momentum =
      std::hypot(to_double(body.spin.x), to_double(body.spin.y), to_double(body.spin.z));
  const Unit least = min(min(body.inertia.x, body.inertia.y), body.inertia.z);
  return momentum / to_double(least);
}

double angle_between(const Quat& a, const Quat& b) {
  const RotationVector turn = rotation_between(a, b);
  return std::hypot(to_double(turn.x), to_double(turn.y), to_double(turn.z));
}

// Moments that a solid can have, ratios up to 4096 among them.
Vec3<Unit> random_inertia(test::Random& random) {
  const auto part = [&] {
    const auto bits = static_cast<int>(random.between(18, 28));
    return static_cast<std::int32_t>(
        random.between(std::int64_t{1} << bits, std::int64_t{2} << bits));
  };
  const std::int32_t x = part(), y = part(), z = part();
  return {Unit::from_raw(y + z), Unit::from_raw(z + x), Unit::from_raw(x + y)};
}

Vec3<Velocity> random_spin(test::Random& random, Velocity most) {
  const auto part = [&] { return Velocity::from_raw(random.between(-most.raw, most.raw)); };
  const Velocity x = part(), y = part(), z = part();
  return {x, y, z};
}

TEST(FreeRotation, KeepsTheEnergyOfEveryBody) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 300; ++run) {
    BodyRecord body = body_of(random_inertia(random), 0);
    const double most = std::exp2(static_cast<double>(random.between(-8, 8)));
    body.spin = random_spin(random, Velocity::from_raw(std::llround(std::ldexp(most, 26))));
    const double before = energy(body);
    double worst = 0;
    for (int tick = 0; tick < 200; ++tick) {
      step(body, 60);
      worst = std::max(worst, std::abs(energy(body) / before - 1));
    }
    const bool fits = fastest_turn(body) < 32 * 60;
    EXPECT_LT(worst, fits ? 5e-3 : 1.0) << "run " << run;
  }
}

TEST(FreeRotation, EndsWhereManySmallStepsEnd) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 100; ++run) {
    BodyRecord coarse = body_of(random_inertia(random), 0);
    coarse.spin = random_spin(random, Velocity::from_ratio(1, 64));
    const double w = energy(coarse);
    if (w > 100) continue;
    BodyRecord fine = coarse;
    for (int tick = 0; tick < 10; ++tick)
      step(coarse, 60);
    for (int tick = 0; tick < 320; ++tick)
      step(fine, 60 * 32);
    EXPECT_LT(angle_between(coarse.orientation, fine.orientation), 2e-4) << "run " << run;
  }
}

TEST(FreeRotation, OfATopIsOneTurnAndExact) {
  BodyRecord top = body_of({0.25_r, 0.25_r, 0.5_r}, 1);
  top.spin = {1_mps, -2_mps, 20_mps};
  BodyRecord other = top;
  EXPECT_EQ(step(top, 10), 1U);
  for (int tick = 0; tick < 48; ++tick)
    step(other, 480);
  EXPECT_LT(angle_between(top.orientation, other.orientation), 1e-6);
}

TEST(FreeRotation, WithoutSpinIsRest) {
  BodyRecord body = body_of({0.1_r, 0.2_r, 0.25_r}, 0);
  body.orientation = normalized({0.1_r, 0.2_r, 0.3_r, 0.9_r});
  const Quat before = body.orientation;
  EXPECT_EQ(step(body, 60), 0U);
  EXPECT_EQ(body.orientation, before);
}

TEST(FreeRotation, OfTheMirrorImageIsTheMirrorImage) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 50; ++run) {
    BodyRecord body = body_of(random_inertia(random), 0);
    body.spin = random_spin(random, 10_mps);
    BodyRecord image = body;  // in the plane x = 0: an axial vector keeps its x
    image.spin.y = -image.spin.y;
    image.spin.z = -image.spin.z;
    for (int tick = 0; tick < 20; ++tick)
      step(body, 60), step(image, 60);
    const Quat& q = body.orientation;
    EXPECT_EQ(image.orientation, (Quat{q.x, -q.y, -q.z, q.w})) << "run " << run;
  }
}

TEST(FreeRotation, StaysDefinedAtTheEndsOfItsRange) {
  constexpr Velocity k_most = k_speed_limit;
  constexpr Unit k_one = Unit::from_integer(1);
  for (const Vec3<Unit>& inertia : {Vec3<Unit>{k_min_inertia, k_one, k_one},
                                    {k_min_inertia, k_min_inertia, k_one},
                                    {k_min_inertia, k_min_inertia + k_min_inertia, k_one},
                                    {k_one, k_one, k_min_inertia}}) {
    for (const int scale : {-9, 0, 10}) {
      for (const std::int32_t rate : {10, 480 * 16}) {
        BodyRecord body = body_of(inertia, scale);
        body.spin = {k_most, -k_most, k_most};
        for (int tick = 0; tick < 4; ++tick)
          step(body, rate);
        EXPECT_NEAR(to_double(body.orientation.x * body.orientation.x +
                              body.orientation.y * body.orientation.y +
                              body.orientation.z * body.orientation.z +
                              body.orientation.w * body.orientation.w),
                    1, 1e-8);
      }
    }
  }
}

// Spheres and cubes turn about one axis only, capsules are tops, boxes of three lengths are not.
TEST(FreeRotation, CostsOnlyTheTurnsThatTheShapeNeeds) {
  const auto turns = [](const Shape& shape) {
    World world = test::make_world({.body_capacity = 2, .gravity = {}});
    BodyDef def;
    def.shape = shape;
    def.angular_velocity = {5_rps, 4_rps, 3_rps};
    test::add(world, def);
    return world.step().axis_turns;
  };
  EXPECT_EQ(turns(Shape::sphere(1_m)), 0U);
  EXPECT_EQ(turns(Shape::box(1_m, 1_m, 1_m)), 0U);
  EXPECT_EQ(turns(Shape::capsule(1_m, 0.1_m)), 1U);
  EXPECT_EQ(turns(Shape::box(1_m, 0.1_m, 1_m)), 1U);
  EXPECT_EQ(turns(Shape::box(1_m, 2_m, 3_m)), 13U);
}

}  // namespace
}  // namespace lockstone
