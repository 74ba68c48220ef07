// Motorcycles that lean through a slalom, and tanks that turn on the spot and push crates.
#include <lockstone/trigonometry.h>
#include <lockstone/vector_math.h>
#include <lockstone/vehicle.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr int k_cycles = 3, k_cones = 4, k_spacing_m = 12;

WorldDef track_world() {
  WorldDef def = small_world();
  def.vehicle_capacity = 4;
  return def;
}

// The steering angle towards a place, ±1, and how far it is aside.
Angle bearing(const World& world, BodyHandle body, const Vec3<Position>& target) {
  const Transform pose = pose_of(world, body);
  const Vec3<Length> way =
      saturated<Length>(Vec3<Position>{target.x - pose.position.x, {}, target.z - pose.position.z});
  const Vec3<Length> seen = rotate_inverse(to_matrix(pose.orientation), way);
  return atan2(seen.z, seen.x);
}

// So many hundredths of it a radian, bounded.
Unit share_of(Angle aside, std::int64_t hundredths, Unit most) {
  const std::int64_t wide =
      (std::int64_t{aside.raw} << (Unit::frac_bits - Angle::frac_bits)) * hundredths / 100;
  return clamp(Unit::from_raw(raw::saturate<std::int32_t>(wide)), -most, most);
}

void build_motorcycle(World& world, std::uint64_t) {
  BodyDef road = fixed(Shape::box(34_m, 0.5_m, 5_m), {14_m, -0.5_m, {}});
  road.material.friction = 0.95_r;
  add(world, road);
  for (int i = 0; i < k_cones; ++i)
    add(world,
        fixed(Shape::cone(0.3_m, 0.25_m), {Position::from_integer(i * k_spacing_m), 0.3_m, {}}));
  for (int i = 0; i < k_cycles; ++i) {
    BodyDef def = loose(Shape::box(0.7_m, 0.45_m, 0.12_m), {Position::from_integer(-8 - 5 * i),
                                                            0.65_m, Position::from_integer(i - 1)});
    def.mass.mass = 250_kg;
    const BodyHandle body = add(world, def);
    order(world, SetVehicle{body, make_motorcycle(1.5_m, -0.25_m, Torque::from_integer(60))});
  }
}

// Past the next cone on the other side than the one before, and away behind the last one.
void drive_motorcycle(World& world, std::uint64_t) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (!vehicle_of(world, body)) continue;
    const auto metres = static_cast<int>(world.position(body).x.raw >> Position::frac_bits);
    const int next = (metres + 2 + 10 * k_spacing_m) / k_spacing_m - 9;
    const Position side =
        next >= 0 && next < k_cones ? Position(next % 2 == 0 ? 1.6_m : -1.6_m) : Position{};
    const Vec3<Position> target{Position::from_integer(next * k_spacing_m + 1), {}, side};
    VehicleControls controls;
    controls.steer = share_of(bearing(world, body, target), 70, Unit::from_ratio(3, 10));
    if (world.velocity(body).x < 8_mps) controls.throttle = Unit::from_ratio(1, 2);
    order(world, DriveVehicle{body, controls});
  }
}

void build_tank(World& world, std::uint64_t) {
  BodyDef ground = fixed(Shape::half_space(), {});
  ground.material.friction = 0.95_r;
  add(world, ground);
  add(world, fixed(Shape::box(0.6_m, 0.1_m, 3_m), {6_m, 0.1_m, {}}));
  for (int i = 0; i < 12; ++i) {
    BodyDef crate = loose(Shape::box(0.5_m, 0.5_m, 0.5_m), {});
    crate.position = {Position::from_ratio(1200 + i % 3 * 10, 100),
                      Position::from_ratio(i / 3 * 101 + 50, 100),
                      Position::from_ratio(i % 3 * 105 - 105, 100)};
    add(world, crate);
  }
  for (int i = 0; i < 2; ++i) {
    BodyDef def = loose(Shape::box(2_m, 0.45_m, 1_m), {i == 0 ? Position{} : Position(2_m), 1_m,
                                                       i == 0 ? Position{} : Position(8_m)});
    def.mass.mass = 12000_kg;
    const BodyHandle body = add(world, def);
    VehicleDef tank = make_tank(3_m, 1.2_m, -0.25_m, Torque::from_integer(1500));
    tank.cast = WheelCast::sphere;
    order(world, SetVehicle{body, tank});
  }
}

// The first one climbs the step and pushes the crates; the second one turns on the spot.
void drive_tank(World& world, std::uint64_t) {
  bool is_first = true;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (!vehicle_of(world, body)) continue;
    VehicleControls controls{.throttle = Unit::from_ratio(8, 10)};
    controls.steer =
        is_first ? share_of(bearing(world, body, {40_m, {}, {}}), 50, Unit::from_ratio(1, 2))
                 : Unit::from_integer(world.tick() < 180 ? 1 : -1);
    order(world, DriveVehicle{body, controls});
    is_first = false;
  }
}

}  // namespace

constinit const Scene k_motorcycle{
    .name = "motorcycle",
    .description = "three motorcycles lean through a slalom",
    .golden_ticks = 300,
    .define = track_world,
    .builder = build_motorcycle,
    .drive = drive_motorcycle,
};

constinit const Scene k_tank{
    .name = "tank",
    .description = "a tank climbs a step and pushes crates, another one turns on the spot",
    .golden_ticks = 300,
    .define = track_world,
    .builder = build_tank,
    .drive = drive_tank,
};

}  // namespace lockstone::scenes
