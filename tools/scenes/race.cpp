// Sixteen cars race round a track over hills, each driven by a player or by a simple bot.
#include <array>
#include <vector>

#include <lockstone/trigonometry.h>
#include <lockstone/vector_math.h>
#include <lockstone/vehicle.h>

#include "tools/scenes/assets.h"
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr int k_samples = 65, k_cell_mm = 3000, k_half_mm = (k_samples - 1) * k_cell_mm / 2;
constexpr int k_waypoints = 24, k_cars = 16;
constexpr Unit k_throttle = Unit::from_ratio(7, 10), k_braking = Unit::from_ratio(1, 2);
constexpr std::int64_t k_long_mm = 70'000, k_short_mm = 42'000;  // half axes of the track

struct Waypoint {
  Position x, z;
};

Unit sine(std::int64_t of_turn, std::int64_t parts) {
  return sin(Angle::from_ratio(of_turn * 6'283'185 / parts % 6'283'185, 1'000'000));
}

// Round an ellipse, to the right.
Waypoint waypoint(std::int64_t i, std::int64_t parts) {
  const auto along = [&](Unit part, std::int64_t mm) {
    return rounded<Position>(part * Length::from_ratio(mm, 1000));
  };
  return {along(sine(i + parts / 4, parts), k_long_mm), along(sine(i, parts), k_short_mm)};
}

std::int32_t height_mm(int i, int j) {
  const auto wave = [](int at, int period, std::int64_t mm) {
    return static_cast<std::int32_t>(sine(at, period).raw * mm >> Unit::frac_bits);
  };
  return wave(i + 2 * j, 31, 700) + wave(3 * i - j, 43, 500) + wave(j, 9, 60);
}

AssetPtr hills() {
  std::vector<Length> heights;
  for (int j = 0; j < k_samples; ++j)
    for (int i = 0; i < k_samples; ++i)
      heights.push_back(millimetres_long(height_mm(i, j)));
  HeightFieldDef def;
  def.columns = def.rows = k_samples;
  def.origin = {millimetres_long(-k_half_mm), {}, millimetres_long(-k_half_mm)};
  def.cell_x = def.cell_z = millimetres_long(k_cell_mm);
  def.heights = heights;
  const HeightFieldResult made = HeightField::build(def);
  LKS_CHECK(made.ok());
  return made.height_field;
}

std::vector<AssetPtr> race_assets(std::uint64_t) {
  return {hills()};
}

WorldDef race_world() {
  WorldDef def = small_world();
  def.vehicle_capacity = k_cars;
  return def;
}

VehicleDef racer(int i) {
  VehicleDef car = make_car(2.5_m, 0.75_m, -0.1_m, Torque::from_integer(260 + i % 4 * 40));
  car.axles[0].frequency = car.axles[1].frequency = Number::from_ratio(20, 10);
  if (i % 3 == 1) car.axles[0].drive = Unit::from_integer(1);  // all wheels
  if (i % 4 == 2) car.cast = WheelCast::sphere;
  return car;
}

void add_car(World& world, int i) {
  const Waypoint at = waypoint(i, k_cars), next = waypoint(i + 1, k_cars);
  const Angle heading = atan2(at.z - next.z, next.x - at.x);
  BodyDef def = loose(Shape::box(1.9_m, 0.3_m, 0.8_m), {at.x, 2.2_m, at.z});
  def.orientation = from_axis_angle(k_y_axis, heading);
  def.mass.mass = Mass::from_integer(1100 + i % 5 * 100);
  const BodyHandle car = add(world, def);
  order(world, SetVehicle{car, racer(i)});
}

void build_race(World& world, std::uint64_t seed) {
  BodyDef ground = fixed(race_assets(seed)[0]->shape(), {});
  ground.material.friction = 0.9_r;
  add(world, ground);
  for (int i = 0; i < k_cars; ++i)
    add_car(world, i);
}

// The waypoint after the next one: the nearest is where the car is.
Waypoint target_of(const Vec3<Position>& at) {
  int nearest = 0;
  Length least = Length::max();
  for (int i = 0; i < k_waypoints; ++i) {
    const Waypoint point = waypoint(i, k_waypoints);
    const Length far =
        length(saturated<Length>(Vec3<Position>{point.x - at.x, {}, point.z - at.z}));
    if (far >= least) continue;
    least = far;
    nearest = i;
  }
  return waypoint(nearest + 2, k_waypoints);
}

// Towards the target; slower where it has to turn.
VehicleControls controls_of_bot(const World& world, BodyHandle car) {
  const Transform pose = pose_of(world, car);
  const Waypoint target = target_of(pose.position);
  const Vec3<Length> way =
      saturated<Length>(Vec3<Position>{target.x - pose.position.x, {}, target.z - pose.position.z});
  const Vec3<Length> seen = rotate_inverse(to_matrix(pose.orientation), way);
  const Angle aside = atan2(seen.z, seen.x);
  const Velocity speed = length(world.velocity(car));
  const Velocity wanted = Velocity::from_integer(13 + car.index % 5) -
                          Velocity::from_raw(std::int64_t{abs(aside).raw} << 6);
  VehicleControls controls;
  controls.steer = clamp(Unit::from_raw(raw::saturate<std::int32_t>(std::int64_t{aside.raw} * 12)),
                         -Unit::from_integer(1), Unit::from_integer(1));
  if (speed < wanted) controls.throttle = k_throttle;
  if (speed > wanted + 2_mps) controls.brake = k_braking;
  return controls;
}

void drive_race(World& world, std::uint64_t) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    if (const BodyHandle body = world.body_at(i); vehicle_of(world, body))
      order(world, DriveVehicle{body, controls_of_bot(world, body)});
}

// Of a player's slot: the first body is the ground.
BodyHandle car_of(const World& world, std::size_t slot) {
  return world.body_at(static_cast<std::uint32_t>(slot) + 1);
}

// An input: the steering, and a bit for each pedal.
constexpr std::uint8_t k_gas = 1, k_brake = 2;

void press(const World& world, std::size_t slot, std::span<std::byte> out) {
  const VehicleControls controls = controls_of_bot(world, car_of(world, slot));
  ByteWriter writer(out);
  writer.put(controls.steer.raw);
  writer.put(static_cast<std::uint8_t>((controls.throttle > Unit{} ? k_gas : 0) |
                                       (controls.brake > Unit{} ? k_brake : 0)));
}

void apply(World& world, std::size_t slot, ByteView input) {
  ByteReader reader(input);
  constexpr Unit k_full = Unit::from_integer(1);
  VehicleControls controls;
  controls.steer = clamp(Unit::from_raw(reader.get<std::int32_t>()), -k_full, k_full);
  const auto pedals = reader.get<std::uint8_t>();
  if ((pedals & k_gas) != 0) controls.throttle = k_throttle;
  if ((pedals & k_brake) != 0) controls.brake = k_braking;
  order(world, DriveVehicle{car_of(world, slot), controls});
}

constexpr ScenePlayers k_drivers{.count = k_cars, .input_bytes = 5, .press = press, .apply = apply};

}  // namespace

constinit const Scene k_race{.name = "race",
                             .description = "16 cars race round a track over hills, driven by bots",
                             .golden_ticks = 300,
                             .define = race_world,
                             .builder = build_race,
                             .drive = drive_race,
                             .assets = race_assets,
                             .players = &k_drivers};

}  // namespace lockstone::scenes
