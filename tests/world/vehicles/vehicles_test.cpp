// Vehicles against the formulas of their motion.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <lockstone/rollback_history.h>
#include <lockstone/vehicle.h>

#include "tests/world/vehicles/vehicle_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::drive;
using test::ground_speed;
using test::k_full;
using test::make_road;
using test::metres;
using test::metres_per_second;

constexpr double k_gravity = test::k_earth_gravity, k_pi = 3.14159265358979;
constexpr Length k_wheelbase = 2.5_m;

VehicleDef car() {
  VehicleDef def = make_car(k_wheelbase, 0.75_m, -0.1_m, Torque::from_integer(350));
  def.tyre.rolling_resistance = {};
  return def;
}

// 1500 kg; half extents 2.1 × 0.35 × 0.85 m.
BodyDef chassis_def() {
  BodyDef def = test::dynamic_body(Shape::box(2.1_m, 0.35_m, 0.85_m), {}, 0.75_m, {});
  def.mass.mass = Mass::from_integer(1500);
  return def;
}

BodyHandle add_car(World& world, const VehicleDef& vehicle, const BodyDef& def = chassis_def()) {
  return test::add_vehicle(world, vehicle, def);
}

// At rest on its springs, then at a speed, with the wheels turning.
void set_speed(World& world, BodyHandle car, Velocity speed) {
  drive(world, car, {.gear = 0});
  test::step(world, 180);
  EXPECT_EQ(world.apply(SetVelocity{car, {speed, {}, {}}}), Status::ok);
  test::step(world, 20);
}

// v² / (2 μ g), with brakes that hold each wheel at 90 % of its grip: the loads of the axles shift
// by μ m g h / L. A driver who stamps on them locks the wheels.
TEST(Vehicles, BrakeOverTheDistanceOfTheirGrip) {
  World world = make_road();
  VehicleDef def = car();
  const double height = 0.33 + 0.25 + 0.1 - k_gravity / std::pow(2 * k_pi * 1.5, 2);
  const double moved = 0.9 * height / 2.5;  // of the weight
  for (std::size_t i = 0; i < 2; ++i) {
    const double load = 1500 * k_gravity * (0.5 + (i == 0 ? moved : -moved)) / 2;
    def.axles[i].brake = Torque::from_integer(std::llround(0.9 * load * 0.33));
  }
  const BodyHandle body = add_car(world, def);
  set_speed(world, body, 30_mps);
  for (int i = 1; i <= 60; ++i) {
    drive(world, body, {.brake = Unit::from_ratio(i, 60), .gear = 0});
    test::step(world, 1);
  }
  const double v = ground_speed(world, body), from = metres(world.position(body).x);
  test::step(world, 300);
  const double way = metres(world.position(body).x) - from;
  const double reference = v * v / (2 * 0.9 * k_gravity);
  std::printf("brakes from %.3f m/s over %.3f m, reference %.3f m\n", v, way, reference);
  EXPECT_LT(ground_speed(world, body), 1e-3);
  EXPECT_NEAR(way, reference, 0.03 * reference);
}

// F = μ m g · sin(C π/2) of locked wheels, C = 1.65
TEST(Vehicles, SlideWithLockedWheels) {
  World world = make_road();
  VehicleDef def = car();
  for (Axle& axle : std::span(def.axles).first(2))
    axle.brake = Torque::from_integer(20000);
  const BodyHandle body = add_car(world, def);
  set_speed(world, body, 30_mps);
  drive(world, body, {.brake = k_full, .gear = 0});
  test::step(world, 30);
  const double v = ground_speed(world, body);
  test::step(world, 60);
  const double slowed = v - ground_speed(world, body);
  // at a slip of 1, ten times the best one; the table ends at eight times
  const double slip = 8 * std::tan(k_pi / 2 / 1.65);
  std::printf("slides: %.4f m/s², reference %.4f\n", slowed,
              k_gravity * std::sin(1.65 * std::atan(slip)));
  EXPECT_NEAR(slowed, k_gravity * std::sin(1.65 * std::atan(slip)), 0.02);
}

// a = T · ratio / (r · m'), m' with the wheels and the engine
TEST(Vehicles, AccelerateByTheTorqueOfTheirEngine) {
  World world = make_road();
  VehicleDef def = car();
  def.engine.torque.fill(Torque::from_integer(200));
  def.gearbox.automatic = false;
  const BodyHandle body = add_car(world, def);
  set_speed(world, body, 12_mps);
  drive(world, body, {.throttle = k_full, .gear = 2});
  test::step(world, 60);
  const double v = ground_speed(world, body);
  test::step(world, 60);
  const double gained = ground_speed(world, body) - v;
  const double ratio = 2.05 * 3.7, radius = 0.33;
  const double mass = 1500 + (4 * 1.2 + 0.2 * ratio * ratio) / (radius * radius);
  std::printf("accelerates: %.4f m/s², reference %.4f\n", gained, 200 * ratio / radius / mass);
  EXPECT_NEAR(gained, 200 * ratio / radius / mass, 0.02 * gained);
}

// f = √(k/m) / 2π; a damping ratio ζ lets each swing shrink by exp(−2πζ/√(1−ζ²)).
TEST(Vehicles, BounceAtTheFrequencyOfTheirSprings) {
  for (const double damping : {0.0, 0.2}) {
    World world = make_road();
    VehicleDef def = car();
    for (Axle& axle : std::span(def.axles).first(2)) {
      axle.damping_ratio = Number::from_ratio(static_cast<std::int64_t>(damping * 10), 10);
      axle.anti_roll = {};
    }
    BodyDef chassis = chassis_def();
    chassis.position.y = 0.62_m;
    const BodyHandle body = add_car(world, def, chassis);
    drive(world, body, {.gear = 0});
    std::vector<double> crossings, peaks;
    const double rest = 0.33 + 0.25 + 0.1 - k_gravity / std::pow(2 * k_pi * 1.5, 2);
    double before = metres(world.position(body).y) - rest, peak = 0;
    for (int i = 1; i <= 300; ++i) {
      test::step(world, 1);
      const double now = metres(world.position(body).y) - rest;
      peak = std::max(peak, now);
      if (before < 0 && now >= 0) {
        crossings.push_back((i - now / (now - before)) / 60);
        peaks.push_back(peak);
        peak = 0;
      }
      before = now;
    }
    ASSERT_GE(crossings.size(), 4U);
    const double period = (crossings[3] - crossings[0]) / 3;
    const double wanted = 1 / (1.5 * std::sqrt(1 - damping * damping));
    std::printf("period %.5f s, reference %.5f; swing kept %.4f, reference %.4f\n", period, wanted,
                peaks[3] / peaks[2],
                std::exp(-2 * k_pi * damping / std::sqrt(1 - damping * damping)));
    EXPECT_NEAR(period, wanted, 0.02 * wanted);
    EXPECT_NEAR(peaks[3] / peaks[2],
                std::exp(-2 * k_pi * damping / std::sqrt(1 - damping * damping)), 0.06);
  }
}

// Ackermann: R = L / tan δ at the middle of the axle that is not steered.
TEST(Vehicles, CornerSlowlyOnTheRadiusOfAckermann) {
  World world = make_road();
  VehicleDef def = car();
  def.axles[1].differential_lock = {};
  const BodyHandle body = add_car(world, def);
  set_speed(world, body, 2_mps);
  drive(world, body, {.steer = Unit::from_ratio(1, 2), .gear = 0});
  test::step(world, 60);
  const BodyView view = world.body(body);
  const double turning = std::ldexp(static_cast<double>(view.angular_velocity.y.raw), -32);
  const double v = ground_speed(world, body);
  const double at_rear = std::sqrt(v * v / (turning * turning) - 1.25 * 1.25);
  std::printf("radius %.4f m, reference %.4f m, turning %.4f\n", at_rear, 2.5 / std::tan(0.3),
              turning);
  EXPECT_LT(turning, 0);  // to the right
  EXPECT_NEAR(at_rear, 2.5 / std::tan(0.3), 0.02 * at_rear);
}

// The steering angle for a radius R at a speed v is L/R + K v²/(g R). A car whose tyres are alike
// and whose mass stands in the middle has K = 0 while its tyres are far from their limit.
TEST(Vehicles, SteerNeutrallyWhenBalanced) {
  World world = make_road();
  VehicleDef def = car();
  for (Axle& axle : std::span(def.axles).first(2))
    axle.anti_roll = {}, axle.differential_lock = {};
  const BodyHandle body = add_car(world, def);
  set_speed(world, body, 15_mps);
  drive(world, body, {.steer = Unit::from_ratio(1, 20), .gear = 0});
  test::step(world, 120);
  const double turning =
      std::abs(std::ldexp(static_cast<double>(world.body(body).angular_velocity.y.raw), -32));
  const double radius = ground_speed(world, body) / turning;
  const double gradient = (0.03 - 2.5 / radius) / (ground_speed(world, body) *
                                                   ground_speed(world, body) / k_gravity / radius);
  std::printf("radius %.3f m, reference %.3f m; understeer gradient %.5f rad\n", radius, 2.5 / 0.03,
              gradient);
  EXPECT_NEAR(gradient, 0, 0.01);
}

// No more than a millimetre in a minute.
TEST(Vehicles, StandOnASlopeWithoutCreeping) {
  World world = test::make_world({.body_capacity = 64, .vehicle_capacity = 4});
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = Shape::half_space();
  ground.material.friction = 1_r;
  ground.orientation = from_axis_angle({{}, {}, k_full}, 30_deg);
  test::add(world, ground);
  BodyDef chassis = chassis_def();
  chassis.orientation = ground.orientation;
  chassis.position = {-0.375_m, 0.65_m, {}};
  const BodyHandle body = add_car(world, car(), chassis);
  drive(world, body, {.brake = k_full, .handbrake = k_full, .gear = 0});
  test::step(world, 600);
  const Vec3<Position> from = world.position(body);
  test::step(world, 3600);
  const Vec3<Position> gone = world.position(body) - from;
  const double way = std::hypot(metres(gone.x), metres(gone.y), metres(gone.z));
  std::printf("creeps %.9f m in 60 s\n", way);
  EXPECT_LT(way, 1e-3);
}

TEST(Vehicles, ShiftUpAsTheyGainSpeed) {
  World world = make_road();
  const BodyHandle body = add_car(world, car());
  drive(world, body, {.throttle = k_full, .gear = 1});
  test::step(world, 60 * 15);
  const std::optional<VehicleView> view = vehicle_of(world, body);
  ASSERT_TRUE(view);
  std::printf("after 15 s: %.2f m/s, gear %d\n", ground_speed(world, body), view->gear);
  EXPECT_GE(view->gear, 3);
  EXPECT_GT(ground_speed(world, body), 30);
  EXPECT_NEAR(metres(world.position(body).z), 0, 0.5);
  EXPECT_FALSE(world.find_fault());
}

TEST(Vehicles, DriveBackwardsAndStayWhereNothingDrives) {
  World world = make_road();
  const BodyHandle body = add_car(world, car());
  drive(world, body, {.throttle = Unit::from_ratio(1, 2), .gear = -1});
  test::step(world, 180);
  EXPECT_LT(metres_per_second(world.velocity(body).x), -3);
  World other = make_road();
  const BodyHandle still = add_car(other, car());
  drive(other, still, {.gear = 1});
  test::step(other, 600);
  EXPECT_NEAR(metres(other.position(still).x), 0, 1e-3);
}

TEST(Vehicles, RollOverStepsOnSpheres) {
  World world = make_road();
  test::add_step(world, Shape::box(5_m, 0.06_m, 5_m), {12_m, 0.06_m, {}});
  VehicleDef def = car();
  def.cast = WheelCast::sphere;
  const BodyHandle body = add_car(world, def);
  drive(world, body, {.throttle = Unit::from_ratio(1, 3), .gear = 1});
  test::step(world, 240);
  EXPECT_GT(metres(world.position(body).x), 12);
  EXPECT_FALSE(world.find_fault());
}

TEST(Vehicles, PushTheGroundThatBearsThem) {
  World world = make_road();
  BodyDef raft = test::dynamic_body(Shape::box(4_m, 0.2_m, 3_m), {}, 0.2_m, {});
  raft.mass.mass = Mass::from_integer(3000);
  raft.material.friction = {};
  const BodyHandle under = test::add(world, raft);
  EXPECT_EQ(world.apply(SetSurfaceRule{0, 0, PairSurface{}}), Status::ok);
  BodyDef chassis = chassis_def();
  chassis.position.y = 1.15_m;
  VehicleDef def = car();
  def.axles[0].friction = def.axles[1].friction = Coefficient(1.9_r);
  const BodyHandle body = add_car(world, def, chassis);
  EXPECT_EQ(world.apply(SetMaterial{under, Surface{.friction = 1_r}}), Status::ok);
  drive(world, body, {.throttle = Unit::from_ratio(1, 4), .gear = 1});
  test::step(world, 60);
  const double ahead = 1500 * metres_per_second(world.velocity(body).x);
  const double back = 3000 * metres_per_second(world.velocity(under).x);
  EXPECT_GT(ahead, 100);
  EXPECT_NEAR(ahead + back, 0, 0.02 * ahead);  // momentum
}

TEST(Vehicles, GoWithTheirChassisAndAreBounded) {
  World world = test::make_world({.body_capacity = 64, .vehicle_capacity = 2});
  const BodyHandle a = add_car(world, car()), b = add_car(world, car());
  const BodyHandle c = test::add(world, chassis_def());
  EXPECT_EQ(world.apply(SetVehicle{c, car()}), Status::capacity_exhausted);
  EXPECT_TRUE(static_cast<bool>(world.explain(SetVehicle{c, car()})));
  EXPECT_EQ(world.apply(DriveVehicle{c, {}}), Status::invalid_argument);
  EXPECT_EQ(world.apply(DestroyBody{a}), Status::ok);
  EXPECT_EQ(world.apply(SetVehicle{c, car()}), Status::ok);
  EXPECT_EQ(vehicle_of(world, c)->def, car());
  EXPECT_EQ(world.apply(SetVehicle{b, {}}), Status::ok);
  EXPECT_FALSE(vehicle_of(world, b));
  EXPECT_FALSE(world.find_fault());
}

TEST(Vehicles, AreRefusedOutOfRange) {
  World world = make_road();
  const BodyHandle body = test::add(world, chassis_def());
  for (int i = 0; i < 6; ++i) {
    VehicleDef def = car();
    if (i == 0) def.axle_count = 4;
    if (i == 1) def.axles[1].radius = {};
    if (i == 2) def.tyre.relaxation = {};
    if (i == 3) def.engine.idle_speed = def.engine.max_speed * 2;
    if (i == 4) def.gearbox.final_drive = {};
    if (i == 5) def.wheel_inertia = {};
    EXPECT_EQ(world.apply(SetVehicle{body, def}), Status::invalid_argument) << i;
    EXPECT_TRUE(static_cast<bool>(world.explain(SetVehicle{body, def}))) << i;
  }
}

// Saved at any tick, loaded elsewhere, with and without derived data: the same future.
TEST(Vehicles, GoOnFromASnapshot) {
  World world = make_road();
  const BodyHandle body = add_car(world, car());
  World other = make_road();
  for (int i = 0; i < 240; ++i) {
    const VehicleControls controls{.throttle = k_full, .steer = Unit::from_ratio(i % 40 - 20, 40)};
    drive(world, body, controls);
    const bool loads = i % 16 == 3;
    if (loads) {
      ASSERT_EQ(other.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
                Status::ok);
    }
    test::step(world, 1);
    if (i < 3) continue;
    if (!loads) drive(other, body, controls);
    test::step(other, 1);
    ASSERT_EQ(other.hash().total, world.hash().total) << i;
    other.drop_derived();
  }
}

// Two cars of which one stands on a raft, and boxes that do not sleep.
World car_park() {
  World world = make_road();
  BodyDef raft = test::dynamic_body(Shape::box(4_m, 0.2_m, 3_m), {}, 0.2_m, 20_m);
  raft.mass.mass = Mass::from_integer(3000);
  raft.allow_sleep = false;
  test::add(world, raft);
  for (int i = 0; i < 12; ++i) {
    BodyDef box = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
    box.position.x = Position::from_integer(4 * i - 200);
    box.allow_sleep = false;
    test::add(world, box);
  }
  BodyDef chassis = chassis_def();
  add_car(world, car(), chassis);
  chassis.position = {{}, 1.15_m, 20_m};
  add_car(world, car(), chassis);
  return world;
}

// A wrong guess about one car: the boxes are not computed again, and the states are the same.
TEST(Vehicles, RollBackAsTheyWere) {
  World world = car_park(), other = car_park();
  const BodyHandle cars[] = {world.body_at(14), world.body_at(15)};
  RollbackHistory history(world, 16);
  std::uint32_t recalled = 0;
  const auto controls = [](int tick) {
    return VehicleControls{.throttle = k_full, .steer = Unit::from_ratio(tick % 20 - 10, 20)};
  };
  for (int i = 0; i < 120; i += 8) {
    const BodyHandle body = cars[i / 8 % 2];
    const std::vector<std::byte> saved = test::save(world, SnapshotKind::native);
    for (int j = 0; j < 8; ++j) {
      if (i % 24 == 0) drive(world, body, {.throttle = {}, .gear = 1});
      (void)history.step();
    }
    ASSERT_EQ(world.load(SnapshotKind::native, saved), Status::ok);
    for (int j = 0; j < 8; ++j) {
      drive(world, body, controls(i + j));
      recalled += history.step().recalled_islands;
      drive(other, body, controls(i + j));
      test::step(other, 1);
      ASSERT_EQ(world.hash().total, other.hash().total) << i + j;
    }
  }
  EXPECT_GE(recalled, 120U * 12);
}

// The guess gives a box wheels, or takes a car's away; or the truth does, and the guess does not.
TEST(Vehicles, RollBackWhereTheyComeAndGo) {
  for (int run = 0; run < 4; ++run) {
    const bool comes = run % 2 == 0, was_guessed = run / 2 == 0;
    World world = car_park(), other = car_park();
    const BodyHandle body = world.body_at(comes ? 3 : 15);
    const Command change = comes ? SetVehicle{body, car()} : SetVehicle{body, {}};
    const auto change_if = [&](bool changes, World& of) {
      EXPECT_TRUE(!changes || of.apply(change) == Status::ok);
    };
    RollbackHistory history(world, 16);
    const std::vector<std::byte> saved = test::save(world, SnapshotKind::native);
    change_if(was_guessed, world);
    for (int j = 0; j < 8; ++j)
      (void)history.step();
    ASSERT_EQ(world.load(SnapshotKind::native, saved), Status::ok);
    change_if(!was_guessed, world);
    change_if(!was_guessed, other);
    for (int j = 0; j < 8; ++j) {
      (void)history.step();
      test::step(other, 1);
      ASSERT_EQ(world.hash().total, other.hash().total) << run << ", tick " << j;
    }
  }
}

}  // namespace
}  // namespace lockstone
