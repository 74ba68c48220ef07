// Bodies that continuous collision stops before a tick's end keep no energy of the way that they
// lost.

#include "core/world/phases/motion/early_stop.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/inertia.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

constexpr Vec3<Acceleration> k_gravity{Acceleration{}, -9.75_mps2, Acceleration{}};

// A turning body of 2^-exponent kg.
BodyRecord body_of(std::int8_t exponent, Velocity fall) {
  BodyRecord body;
  body.motion = static_cast<std::uint8_t>(MotionType::dynamic);
  body.inertia = {0.25_r, 0.5_r, 0.5_r};
  body.orientation = {};
  body.gravity_scale = Number::from_integer(1);
  body.inverse_mass = 1 << 30;
  body.inverse_mass_exponent = static_cast<std::int8_t>(exponent - 30);
  body.velocity = {1_mps, -fall, Velocity{}};
  body.spin = {0.5_mps, 0.25_mps, Velocity{}};
  return body;
}

double mass_of(const BodyRecord& body) {
  return std::ldexp(1.0, -30 - body.inverse_mass_exponent);
}

double energy_of(const BodyRecord& body) {
  const InverseInertia inertia = inverse_inertia(body, to_matrix(body.orientation));
  const std::int64_t twice =
      energy_product(body.velocity, body.velocity, body.spin, surface_velocity(inertia, body.spin));
  return mass_of(body) * std::ldexp(static_cast<double>(twice), -33);
}

double energy_of(const std::array<BodyRecord, 2>& bodies) {
  return energy_of(bodies[0]) + energy_of(bodies[1]);
}

// Stops two bodies that began a tick at these velocities, and would go on by these ways upwards.
void stop(std::array<BodyRecord, 2>& bodies, const std::array<BodyRecord, 2>& starts,
          const std::array<Position, 2>& ways) {
  const TimeStep time = TimeStep::of(60, 4);
  EarlyStop early(k_gravity, time);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3<Position> place =
        bodies[i].position - Vec3<Position>{Position{}, ways[i], Position{}};
    early.add(bodies[i], {place, starts[i].orientation}, {starts[i].velocity, starts[i].spin},
              place);
  }
  for (BodyRecord& body : bodies)
    early.slow(body);
}

// Of bodies that gravity has just made faster.
struct Falling {
  std::array<BodyRecord, 2> starts{body_of(0, 2.8_mps), body_of(3, 4.7_mps)};
  std::array<BodyRecord, 2> bodies{body_of(0, 3_mps), body_of(3, 5_mps)};
};

TEST(EarlyStop, TakesTheWorkOfGravityOnTheWaysThatAreLost) {
  Falling falling;
  const double before = energy_of(falling.bodies);
  stop(falling.bodies, falling.starts, {-0.05_m, -0.08_m});
  EXPECT_NEAR(energy_of(falling.bodies), before - 9.75 * (0.05 * 1 + 0.08 * 0.125), 1e-6);
}

TEST(EarlyStop, TakesNoMoreThanTheTickGave) {
  Falling falling;
  stop(falling.bodies, falling.starts, {-1_m, -1_m});
  EXPECT_NEAR(energy_of(falling.bodies), energy_of(falling.starts), 1e-6);
}

TEST(EarlyStop, LeavesBodiesThatAreLetDownAsFastAsBefore) {
  std::array bodies{body_of(0, 3_mps), body_of(3, 5_mps)};
  const std::array before = bodies;
  stop(bodies, before, {-0.05_m, -0.08_m});
  EXPECT_EQ(bodies[0].velocity, before[0].velocity);
  EXPECT_EQ(bodies[1].spin, before[1].spin);
}

TEST(EarlyStop, SlowsAllVelocitiesAlike) {
  Falling falling;
  const std::array before = falling.bodies;
  stop(falling.bodies, falling.starts, {-0.05_m, -0.08_m});
  const double share = to_double(falling.bodies[0].velocity.y) / to_double(before[0].velocity.y);
  EXPECT_LT(share, 0.99);
  for (std::size_t i = 0; i < 2; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(to_double(falling.bodies[i].velocity[axis]),
                  share * to_double(before[i].velocity[axis]), 1e-7);
      EXPECT_NEAR(to_double(falling.bodies[i].spin[axis]), share * to_double(before[i].spin[axis]),
                  1e-7);
    }
  }
}

TEST(EarlyStop, LeavesBodiesThatWouldHaveRisen) {
  Falling falling;
  const std::array before = falling.bodies;
  stop(falling.bodies, falling.starts, {0.05_m, 0.08_m});
  EXPECT_EQ(falling.bodies[0].velocity, before[0].velocity);
  EXPECT_EQ(falling.bodies[1].velocity, before[1].velocity);
}

}  // namespace
}  // namespace lockstone
