// Motorcycles against the formulas of their balance.
#include <cmath>
#include <cstdio>

#include <lockstone/testing/floating.h>

#include "tests/world/vehicles/vehicle_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

constexpr double k_mass = 250;

VehicleDef cycle() {
  VehicleDef def = make_motorcycle(1.5_m, -0.25_m, Torque::from_integer(60));
  def.tyre.rolling_resistance = {};
  return def;
}

BodyDef frame_def(double lean = 0) {
  BodyDef def = test::dynamic_body(Shape::box(0.7_m, 0.5_m, 0.12_m), {}, 0.65_m, {});
  def.mass.mass = Mass::from_integer(250);
  def.orientation = from_axis_angle({test::k_full, {}, {}},
                                    Angle::from_ratio(std::llround(lean * 1e6), 1'000'000));
  return def;
}

double lean_of(const World& world, BodyHandle body) {
  return to_double(vehicle_of(world, body)->lean);
}

// Upright at a speed.
BodyHandle add_rolling(World& world, const VehicleDef& def, int speed) {
  const BodyHandle body = test::add_vehicle(world, def, frame_def());
  test::drive(world, body, {.gear = 0});
  test::step(world, 120);
  EXPECT_EQ(world.apply(SetVelocity{body, {Velocity::from_integer(speed), {}, {}}}), Status::ok);
  test::step(world, 30);
  return body;
}

double energy_of(const World& world, BodyHandle body) {
  const BodyView view = world.body(body);
  const Vec3<Velocity> v = world.velocity(body);
  const double squares = std::pow(test::metres_per_second(v.x), 2) +
                         std::pow(test::metres_per_second(v.y), 2) +
                         std::pow(test::metres_per_second(v.z), 2);
  const double wx = to_double(view.angular_velocity.x), wy = to_double(view.angular_velocity.y),
               wz = to_double(view.angular_velocity.z);
  const double turning = std::sqrt(wx * wx + wy * wy + wz * wz);
  // of the shape of the greatest moment: an upper bound of the turning's part
  const double inertia = k_mass / 3 * (0.7 * 0.7 + 0.5 * 0.5);
  return k_mass * (squares / 2 + test::k_earth_gravity * test::metres(world.position(body).y)) +
         inertia * turning * turning / 2;
}

// tan φ = v² / (g r), the radius that of the centre of mass.
TEST(Motorcycles, LeanSoThatWeightAndCentrifugalForceBalance) {
  for (const int speed : {6, 12, 20}) {
    for (const int side : {-1, 1}) {
      World world = test::make_road();
      const BodyHandle body = add_rolling(world, cycle(), speed);
      const Unit steer = Unit::from_ratio(side * (speed == 6 ? 30 : speed == 12 ? 8 : 3), 100);
      test::drive(world, body, {.steer = steer, .gear = 0});
      test::step(world, 300);
      const double v = test::ground_speed(world, body);
      const double turning = -to_double(world.body(body).angular_velocity.y);
      const double expected = std::atan(v * turning / test::k_earth_gravity);
      std::printf("%.3f m/s, radius %.3f m: lean %.5f rad, reference %.5f\n", v, v / turning,
                  lean_of(world, body), expected);
      EXPECT_GT(expected * side, 0.1);
      EXPECT_NEAR(lean_of(world, body), expected, 0.003);
    }
  }
}

TEST(Motorcycles, StandUprightAndDriveStraight) {
  World world = test::make_road();
  const BodyHandle body = test::add_vehicle(world, cycle(), frame_def());
  test::drive(world, body, {.gear = 0});
  test::step(world, 600);
  EXPECT_NEAR(lean_of(world, body), 0, 1e-3);
  test::drive(world, body, {.throttle = Unit::from_ratio(1, 2), .gear = 1});
  test::step(world, 600);
  EXPECT_GT(test::ground_speed(world, body), 20);
  EXPECT_NEAR(lean_of(world, body), 0, 1e-2);
  EXPECT_NEAR(test::metres(world.position(body).z), 0, 0.5);
}

// One that stands leaning is raised by a spring: by no more energy than that holds, and it does not
// shake then.
TEST(Motorcycles, StandUpAndThenStandStill) {
  World world = test::make_road();
  const BodyHandle body = test::add_vehicle(world, cycle(), frame_def(0.2));
  test::drive(world, body, {.brake = test::k_full, .gear = 0});
  test::step(world, 600);
  EXPECT_NEAR(lean_of(world, body), 0, 1e-3);
  const double start = energy_of(world, body);
  double most = start, least = start;
  for (int i = 0; i < 600; ++i) {
    test::step(world, 1);
    most = std::max(most, energy_of(world, body));
    least = std::min(least, energy_of(world, body));
  }
  std::printf("stands: lean %.6f rad, energy within %.4f J\n", lean_of(world, body), most - least);
  EXPECT_LT(most - least, 0.05);
}

// Slaloms without an engine: the energy never grows.
TEST(Motorcycles, GainNoEnergyInASlalom) {
  for (const int period : {20, 45, 90, 150}) {
    World world = test::make_road();
    const BodyHandle body = add_rolling(world, cycle(), 15);
    const double start = energy_of(world, body);
    double least = start, most_gain = 0, most_lean = 0;
    for (int i = 0; i < 600; ++i) {
      const int side = i / period % 2 == 0 ? 1 : -1;
      test::drive(world, body, {.steer = Unit::from_ratio(side * 8, 100), .gear = 0});
      test::step(world, 1);
      const double now = energy_of(world, body);
      most_gain = std::max(most_gain, now - least);
      least = std::min(least, now);
      most_lean = std::max(most_lean, std::abs(lean_of(world, body)));
    }
    std::printf("slalom of %d ticks: leans to %.2f rad, gains %.4f of its energy, keeps %.3f\n",
                period, most_lean, most_gain / start, least / start);
    EXPECT_LT(most_gain, 0.01 * start) << period;
    EXPECT_LT(most_lean, 1.0);
  }
}

// Nothing balances one that gravity pulls up, or not at all.
TEST(Motorcycles, AreLeftAloneWithoutWeight) {
  for (const int scale : {-1, 0}) {
    World world = test::make_road();
    BodyDef def = frame_def(0.1);
    def.gravity_scale = Number::from_integer(scale);
    const BodyHandle body = test::add_vehicle(world, cycle(), def);
    test::drive(world, body, {.throttle = test::k_full, .steer = Unit::from_ratio(1, 10)});
    test::step(world, 120);
    EXPECT_FALSE(world.find_fault());
  }
}

TEST(Motorcycles, GoOnFromASnapshot) {
  World world = test::make_road(), other = test::make_road();
  const BodyHandle body = test::add_vehicle(world, cycle(), frame_def());
  for (int i = 0; i < 240; ++i) {
    const VehicleControls controls{.throttle = test::k_full,
                                   .steer = Unit::from_ratio(i % 40 - 20, 200)};
    test::drive(world, body, controls);
    const auto saved = test::save(world, SnapshotKind::canonical);
    ASSERT_EQ(other.load(SnapshotKind::canonical, saved), Status::ok);
    test::step(world, 1);
    test::step(other, 1);
    ASSERT_EQ(other.hash().total, world.hash().total) << i;
  }
}

TEST(Motorcycles, AreRefusedWithALeanOutOfRange) {
  World world = test::make_road();
  const BodyHandle body = test::add(world, frame_def());
  VehicleDef def = cycle();
  def.max_lean = 1.3_rad;
  EXPECT_EQ(world.apply(SetVehicle{body, def}), Status::invalid_argument);
  def.max_lean = 0.5_rad;
  EXPECT_EQ(world.apply(SetVehicle{body, def}), Status::ok);
  EXPECT_EQ(vehicle_of(world, body)->def, def);
}

}  // namespace
}  // namespace lockstone
