// A pendulum, a body that hangs on one point: its invariants, and its accuracy.
#include "core/dynamics/joint/pivot_integrator.h"

#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/joint/joint_geometry.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

const Vec3<Acceleration> k_gravity{{}, Acceleration::from_ratio(-981, 100), {}};

struct Hung {
  BodyRecord body;
  Pivot pivot;
  Vec3<Acceleration> gravity = k_gravity;
  TimeStep step = TimeStep::of(60, 1);

  [[nodiscard]] Mat3 rotation() const { return to_matrix(body.orientation); }
  [[nodiscard]] bool can() const {
    return can_step_about_pivot(body, rotation(), pivot, gravity, step);
  }
  PivotStep go() { return step_about_pivot(body, rotation(), pivot, gravity, step); }

  // From the pivot, which is the origin.
  void hang() { body.position = -arm_of(rotation(), pivot.anchor); }

  // Per mass.
  [[nodiscard]] double energy() const {
    const Vec3<Velocity> spin = rotate_inverse_wide(rotation(), body.spin);
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      sum += std::pow(to_double(body.velocity[i]), 2) / 2;
      sum += std::pow(to_double(spin[i]), 2) / to_double(body.inertia[i]) / 2;
      sum -= to_double(gravity[i]) * to_double(body.position[i]);
    }
    return sum;
  }

  // About the pivot, along y; per mass.
  [[nodiscard]] double momentum() const {
    return to_double(body.position.z) * to_double(body.velocity.x) -
           to_double(body.position.x) * to_double(body.velocity.z) +
           std::ldexp(to_double(body.spin.y), body.scale_exponent);
  }
};

Hung hung(const Vec3<Unit>& inertia, const Vec3<Length>& anchor) {
  Hung hung;
  hung.body.motion = static_cast<std::uint8_t>(MotionType::dynamic);
  hung.body.inertia = inertia;
  hung.body.orientation = {};
  hung.body.gravity_scale = Number::from_integer(1);
  hung.pivot.anchor = anchor;
  hung.hang();
  return hung;
}

// An orientation, moments that a solid can have, an anchor on or off its axes.
Hung random_hung(test::Random& random) {
  const auto part = [&](std::int64_t least) {
    return Unit::from_raw(static_cast<std::int32_t>(random.between(least, 1 << 28)));
  };
  const Unit x = part(1 << 25), y = part(1 << 25), z = part(1 << 25);
  const auto length = [&] {
    return Length::from_raw(static_cast<std::int32_t>(random.between(-1 << 20, 1 << 20)));
  };
  Vec3<Length> anchor{length(), length(), length()};
  if (random.between(0, 1) == 0) anchor.x = anchor.z = {};
  Hung made = hung({y + z, z + x, x + y}, anchor);
  made.body.orientation = normalized({part(1), part(1), part(1), part(1)});
  made.hang();
  return made;
}

double distance(const Vec3<Position>& a, const Vec3<Position>& b) {
  return std::hypot(to_double(a.x - b.x), to_double(a.y - b.y), to_double(a.z - b.z));
}

TEST(PivotIntegrator, KeepsEnergyAndMomentumAboutTheVertical) {
  test::Random random;
  for (int i = 0; i < 20; ++i) {
    Hung top = random_hung(random);
    for (int axis = 0; axis < 3; ++axis)
      top.body.spin[axis].raw = random.between(-std::int64_t{1} << 31, std::int64_t{1} << 31);
    top.go();  // whose velocity was not that of its turning
    const double energy = top.energy(), momentum = top.momentum();
    for (int tick = 0; tick < 300; ++tick) {
      top.go();
      ASSERT_NEAR(top.energy(), energy, 2e-4) << "case " << i << ", tick " << tick;
      ASSERT_NEAR(top.momentum(), momentum, 1e-7) << "case " << i << ", tick " << tick;
    }
  }
}

TEST(PivotIntegrator, StaysOnItsPivot) {
  test::Random random;
  Hung top = random_hung(random);
  for (int tick = 0; tick < 300; ++tick) {
    top.go();
    ASSERT_TRUE(top.can());
    const Vec3<Position> held = top.body.position + arm_of(top.rotation(), top.pivot.anchor);
    ASSERT_LT(distance(held, {}), 1e-9);
  }
}

Vec3<Position> place_after(int seconds, int substeps) {
  Hung pendulum = hung({0.2_r, 0.3_r, 0.25_r}, {-2_m, 0.5_m, {}});
  pendulum.step = TimeStep::of(10, substeps);
  for (int tick = 0; tick < 10 * seconds; ++tick)
    pendulum.go();
  return pendulum.body.position;
}

TEST(PivotIntegrator, IsOfFourthOrder) {
  const Vec3<Position> exact = place_after(4, 16);
  const double coarse = distance(place_after(4, 1), exact),
               fine = distance(place_after(4, 2), exact);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, coarse / 10);
}

TEST(PivotIntegrator, TakesForcesForGravity) {
  Hung pulled = hung({0.2_r, 0.3_r, 0.25_r}, {-1_m, {}, {}});
  Hung falling = pulled;
  pulled.gravity = {};
  for (int tick = 0; tick < 120; ++tick) {
    add_gain(pulled.body, {{{}, Velocity::from_ratio(-981, 6000), {}}, {}});
    pulled.go();
    pulled.body.union_a = pulled.body.union_b = {};
    pulled.body.union_c = {};
    pulled.body.flags = 0;
    falling.go();
  }
  EXPECT_LT(distance(pulled.body.position, falling.body.position), 1e-6);
}

TEST(PivotIntegrator, ReturnsTheForceOfTheJoint) {
  Hung still = hung({0.2_r, 0.3_r, 0.25_r}, {{}, 1_m, {}});
  const PivotStep step = still.go();
  EXPECT_EQ(still.body.position, (Vec3<Position>{{}, -1_m, {}}));
  EXPECT_NEAR(to_double(step.impulse.y), 9.81 / 60, 1e-9);
  EXPECT_NEAR(to_double(step.impulse.x), 0, 1e-9);
}

TEST(PivotIntegrator, LeavesOtherBodiesToTheSolver) {
  const Hung good = hung({0.2_r, 0.3_r, 0.25_r}, {-1_m, {}, {}});
  EXPECT_TRUE(good.can());
  Hung open = good;
  open.body.position.x += Position::from_ratio(1, 10000);
  EXPECT_FALSE(open.can());
  Hung thin = hung({k_min_inertia, 0.3_r, 0.3_r}, {-8_m, {}, {}});
  EXPECT_FALSE(thin.can());
  Hung fast = hung({0.2_r, 0.3_r, 0.25_r}, {Length::from_ratio(-1, 1000), {}, {}});
  fast.body.scale_exponent = -9;
  fast.hang();
  EXPECT_TRUE(fast.can());
  fast.gravity.y = Acceleration::from_integer(1 << 20);
  EXPECT_FALSE(fast.can());
}

}  // namespace
}  // namespace lockstone
