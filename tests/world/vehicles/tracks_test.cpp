// Tracked vehicles against the kinematics of their steering.
#include <cmath>
#include <cstdio>

#include <lockstone/testing/floating.h>

#include "tests/world/vehicles/vehicle_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

constexpr double k_half_track = 1.2;

VehicleDef tank(double length = 3) {
  return make_tank(Length::from_ratio(std::llround(length * 1000), 1000), 1.2_m, -0.2_m,
                   Torque::from_integer(1500));
}

BodyDef hull_def() {
  BodyDef def = test::dynamic_body(Shape::box(2_m, 0.4_m, 1_m), {}, 0.9_m, {});
  def.mass.mass = Mass::from_integer(12'000);
  return def;
}

double turning_of(const World& world, BodyHandle body) {
  return -to_double(world.body(body).angular_velocity.y);  // to the right
}

double spin_of(const World& world, BodyHandle body, std::size_t wheel) {
  return to_double(vehicle_of(world, body)->wheels[wheel].spin);
}

// Both sides alike: straight ahead, and up to the speed of its highest gear.
TEST(Tracks, DriveStraight) {
  World world = test::make_road();
  const BodyHandle body = test::add_vehicle(world, tank(), hull_def());
  test::drive(world, body, {.throttle = test::k_full, .gear = 1});
  test::step(world, 900);
  std::printf("%.3f m/s after 15 s\n", test::ground_speed(world, body));
  EXPECT_GT(test::ground_speed(world, body), 8);
  EXPECT_NEAR(test::metres(world.position(body).z), 0, 0.05);
  test::drive(world, body, {.brake = test::k_full});
  test::step(world, 300);
  EXPECT_LT(test::ground_speed(world, body), 0.01);
}

// v = (l + r)·ρ/2, ω = (l − r)·ρ/b for the speeds l and r of the sides, ρ the radius of the wheels:
// R = b/2·(l + r)/(l − r). Tyres slip, the more the longer the tracks are.
TEST(Tracks, TurnOnTheRadiusOfTheirSpeeds) {
  for (const double length : {0.6, 3.0}) {
    World world = test::make_road();
    const BodyHandle body = test::add_vehicle(world, tank(length), hull_def());
    test::drive(world, body, {.throttle = Unit::from_ratio(3, 10), .gear = 1});
    test::step(world, 180);
    test::drive(world, body,
                {.throttle = Unit::from_ratio(3, 10), .steer = Unit::from_ratio(1, 10), .gear = 1});
    test::step(world, 300);
    const double left = spin_of(world, body, 0), right = spin_of(world, body, 1);
    const double radius = test::ground_speed(world, body) / turning_of(world, body);
    const double expected = k_half_track * (left + right) / (left - right);
    std::printf("tracks of %.1f m: r/l %.4f, radius %.3f m, kinematic %.3f m\n", length,
                right / left, radius, expected);
    EXPECT_NEAR(right / left, 0.8, 0.001);  // 1 − 2·steer
    EXPECT_GT(radius, expected);
    EXPECT_LT(radius, expected * (length < 1 ? 1.04 : 2.5));
  }
}

TEST(Tracks, TurnOnTheSpot) {
  for (const int side : {-1, 1}) {
    World world = test::make_road();
    const BodyHandle body = test::add_vehicle(world, tank(), hull_def());
    test::drive(world, body, {.gear = 0});
    test::step(world, 120);
    const Vec3<Position> start = world.position(body);
    test::drive(world, body,
                {.throttle = Unit::from_ratio(1, 2), .steer = Unit::from_integer(side), .gear = 1});
    test::step(world, 180);
    const Vec3<Position> gone = world.position(body) - start;
    std::printf("turns at %.3f rad/s, goes %.4f m\n", turning_of(world, body),
                std::hypot(test::metres(gone.x), test::metres(gone.z)));
    EXPECT_GT(side * turning_of(world, body), 0.3);
    EXPECT_LT(std::hypot(test::metres(gone.x), test::metres(gone.z)), 0.05);
    EXPECT_NEAR(spin_of(world, body, 0), -spin_of(world, body, 1), 0.01);
  }
}

// Halfway one side stands: the hull turns about it.
TEST(Tracks, TurnAboutATrackThatStands) {
  World world = test::make_road();
  const BodyHandle body = test::add_vehicle(world, tank(), hull_def());
  test::drive(world, body,
              {.throttle = Unit::from_ratio(1, 2), .steer = Unit::from_ratio(1, 2), .gear = 1});
  test::step(world, 300);
  EXPECT_NEAR(spin_of(world, body, 1), 0, 0.01);
  EXPECT_GT(spin_of(world, body, 0), 1);
  EXPECT_GT(turning_of(world, body), 0.2);
}

// The wheels of a side are on one shaft.
TEST(Tracks, TurnAsOne) {
  World world = test::make_road();
  test::add_step(world, Shape::box(0.5_m, 0.1_m, 5_m), {5_m, 0.1_m, {}});
  VehicleDef def = tank();
  def.cast = WheelCast::sphere;
  const BodyHandle body = test::add_vehicle(world, def, hull_def());
  test::drive(world, body, {.throttle = test::k_full, .steer = Unit::from_ratio(1, 10), .gear = 1});
  for (int i = 0; i < 240; ++i) {
    test::step(world, 1);
    for (std::size_t side = 0; side < 2; ++side)
      for (const std::size_t axle : {std::size_t{1}, std::size_t{2}})
        ASSERT_EQ(spin_of(world, body, 2 * axle + side), spin_of(world, body, side)) << i;
  }
  EXPECT_GT(test::metres(world.position(body).x), 5);
}

TEST(Tracks, AreRefusedWithWheelsOfSeveralSizes) {
  World world = test::make_road();
  const BodyHandle body = test::add(world, hull_def());
  VehicleDef def = tank();
  def.axles[1].radius = 0.4_m;
  EXPECT_EQ(world.apply(SetVehicle{body, def}), Status::invalid_argument);
  EXPECT_TRUE(static_cast<bool>(world.explain(SetVehicle{body, def})));
  def = tank();
  EXPECT_EQ(world.apply(SetVehicle{body, def}), Status::ok);
  EXPECT_EQ(vehicle_of(world, body)->def, def);
}

}  // namespace
}  // namespace lockstone
