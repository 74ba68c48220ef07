#include "tools/fuzz/random_features.h"

#include <algorithm>
#include <array>
#include <vector>

#include <lockstone/literals.h>
#include <lockstone/path.h>

#include "tools/scenes/assets.h"

namespace lockstone::fuzz {
namespace {

using namespace lockstone::literals;

constexpr std::uint32_t k_panels = 5;

}  // namespace

using arena::mix;
using arena::Random;

std::int64_t log_between(Random& random, std::int64_t low, std::int64_t high) {
  int octaves = 0;
  while ((low << (octaves + 1)) <= high)
    ++octaves;
  const std::int64_t floor = low << random.between(0, octaves);
  const std::uint64_t rest = random.next() % static_cast<std::uint64_t>(floor);
  return std::min(high, floor + static_cast<std::int64_t>(rest));
}

void drive_events(World& world, std::uint64_t seed) {
  Random random(mix(~seed ^ mix(world.tick() + 2)));
  const auto settings = [&] {
    EventSettings events{!chance(random, 4), {}};
    if (chance(random, 2))
      events.hit_speed.raw = static_cast<std::int32_t>(log_between(random, 1, 500 << 20));
    events.persist = chance(random, 4);
    return events;
  };
  for (std::uint32_t i = 0; world.tick() == 0 && i < world.body_limit(); ++i)
    (void)world.apply(SetEvents{world.body_at(i), settings()});
  if (chance(random, 8)) (void)world.apply(SetEvents{any_body(world, random), settings()});
}

namespace {

// Changes of bodies and fluids, drawn apart.
void drive_changes(World& world, std::uint64_t seed) {
  Random random(mix(~seed ^ mix(world.tick() + 5)));
  if (!chance(random, 12)) return;
  const BodyHandle body = any_body(world, random), other = any_body(world, random);
  if (body.is_null() || other.is_null()) return;
  switch (random.below(5)) {
    case 0:
      return (void)world.apply(
          SetMotionType{body, static_cast<MotionType>(1 + random.below(3)), {}});
    case 1:
      return (void)world.apply(SetShape{body, world.body(other).shape, {}});
    case 2:
      return (void)world.apply(
          SetMassData{body, {Mass::from_raw(log_between(random, 1LL << 13, 1LL << 52)), {}}});
    case 3:
      return (void)world.apply(SetEnabled{body, !chance(random, 3)});
    default:
      break;
  }
  Fluid fluid{.surface = world.position(body), .orientation = {}};
  const auto half = [&] { return Position::from_raw(log_between(random, 1LL << 30, 1LL << 40)); };
  fluid.size = {half(), half(), half()};
  fluid.density.raw = chance(random, 3) ? 0 : static_cast<std::int32_t>(random.below(1U << 20));
  fluid.drag.raw = static_cast<std::int32_t>(random.below(2U << 20));
  fluid.linear_drag.raw = static_cast<std::int32_t>(random.below(4U << 20));
  (void)world.apply(SetFluid{random.below(2), fluid});
}

// Of a car: motorcycles of one wheel an axle, and tracks, drawn apart.
void draw_kind(VehicleDef& def, std::uint64_t seed, std::uint64_t tick) {
  Random random(mix(~seed ^ mix(tick + 15)));
  def.kind = static_cast<VehicleKind>(random.below(3));
  def.max_lean = Angle::from_ratio(random.between(0, 12), 10);
  const bool has_tracks = def.kind == VehicleKind::tracked;
  for (Axle& axle : def.axles) {
    if (has_tracks) axle.radius = def.axles[0].radius;
    if (def.kind == VehicleKind::motorcycle && !chance(random, 4)) axle.half_track = {};
  }
}

// Vehicles of any kind, on bodies of any kind, drawn apart.
void drive_vehicles(World& world, std::uint64_t seed) {
  Random random(mix(~seed ^ mix(world.tick() + 9)));
  if (!chance(random, 12)) return;
  const BodyHandle body = any_body(world, random);
  const auto share = [&] { return Unit::from_ratio(random.between(-100, 100), 100); };
  if (chance(random, 2)) {
    const std::int32_t gear = random.between(-1, 8);
    return (void)world.apply(
        DriveVehicle{body, {share(), share(), share(), share(), share(), gear}});
  }
  SetVehicle command{body, {}};
  if (chance(random, 5)) return (void)world.apply(command);
  const auto half = [&] {
    return Length::from_raw(static_cast<std::int32_t>(log_between(random, 1LL << 17, 1LL << 21)));
  };
  const Length length = half(), track = half();
  const Torque torque = Torque::from_integer(random.between(0, 5000));
  command.def = make_car(length, track, -half(), torque);
  for (Axle& axle : command.def->axles) {
    axle.radius = max(half(), Length::from_ratio(1, 20));
    axle.frequency = Number::from_ratio(random.between(2, 100), 10);
    axle.damping_ratio = Number::from_ratio(random.between(0, 20), 10);
    axle.anti_roll = Number::from_ratio(random.between(0, 40), 10);
    axle.differential_lock = Torque::from_integer(random.between(0, 100'000));
  }
  command.def->axle_count = 1 + random.below(3);
  command.def->gearbox.automatic = chance(random, 2);
  command.def->cast = static_cast<WheelCast>(random.below(2));
  draw_kind(*command.def, seed, world.tick());
  (void)world.apply(command);
}

// Edits of height fields, drawn apart: some are refused.
void drive_terrain(World& world, std::uint64_t seed) {
  Random random(mix(~seed ^ mix(world.tick() + 11)));
  if (!chance(random, 6)) return;
  const BodyHandle body = any_body(world, random);
  if (!terrain_sample_of(world, body, 0, 0)) return;
  SetHeights command{.body = body, .column = random.below(9), .row = random.below(9)};
  command.columns = 1 + random.below(5);
  command.rows = 1 + random.below(5);
  std::vector<Length> heights(std::size_t{command.columns} * command.rows);
  const auto middle = static_cast<std::int32_t>(random.between(-1000, 1000));
  for (Length& height : heights)
    height =
        scenes::millimetres_long(middle + static_cast<std::int32_t>(random.between(-300, 300)));
  std::vector<std::uint8_t> holes(std::size_t{command.columns - 1} * (command.rows - 1));
  for (std::uint8_t& hole : holes)
    hole = chance(random, 3) ? 1 : 0;
  if (!chance(random, 4)) command.heights = heights;
  if (chance(random, 3)) command.holes = holes;
  (void)world.apply(command);
}

// Rules about pairs, drawn apart.
void drive_rules(World& world, std::uint64_t seed) {
  Random random(mix(~seed ^ mix(world.tick() + 7)));
  if (!chance(random, 10)) return;
  const auto coefficient = [&] { return Coefficient::from_ratio(random.between(0, 99), 100); };
  const PairSurface surface{coefficient(), coefficient(), coefficient()};
  const BodyHandle body = any_body(world, random);
  switch (random.below(4)) {
    case 0:
      return (void)world.apply(
          SetPairRule{body, any_body(world, random), {chance(random, 2), surface}});
    case 1:
      return (void)world.apply(SetPairRule{body, any_body(world, random), {}});
    case 2:
      return (void)world.apply(SetSurfaceRule{random.below(2), random.below(2), surface});
    default:
      break;
  }
  OneWay one_way;
  if (!chance(random, 4)) one_way.direction = {coefficient(), coefficient(), coefficient()};
  one_way.tolerance = static_cast<std::uint8_t>(random.between(1, 90));
  (void)world.apply(SetOneWay{body, one_way});
}

// Locks of a joint that turn, in a quarter of all scenes. Draws its numbers apart.
void drive_turning_locks(World& world, std::uint64_t seed) {
  Random gate(mix(seed ^ 0x7475726e));
  if (!chance(gate, 4)) return;
  Random random(mix(~seed ^ mix(world.tick() + 5)));
  if (!chance(random, 4)) return;
  const JointHandle joint = any_joint(world, random);
  for (std::uint8_t i = 0; i < 3; ++i) {
    AngularAxis axis{.mode = AxisMode::locked};
    axis.target = Angle::from_ratio(random.between(-300, 300), 100);
    if (chance(random, 2)) axis.speed = Rate::from_ratio(random.between(-5000, 5000), 100);
    (void)world.apply(SetAngularAxis{joint, i, axis});
  }
}

// Ratchets and path joints, in a third of all scenes. Draws its numbers apart.
void drive_tracks(World& world, std::uint64_t seed) {
  Random gate(mix(seed ^ 0x7261696c));
  if (!chance(gate, 3)) return;
  Random random(mix(~seed ^ mix(world.tick() + 13)));
  const int joints = world.tick() == 0 ? random.between(1, 6) : chance(random, 40) ? 1 : 0;
  for (int i = 0; i < joints; ++i) {
    const BodyHandle a = any_body(world, random);
    const BodyHandle b = any_body(world, random);
    JointDef def = JointDef::of(chance(random, 2) ? JointKind::ratchet : JointKind::path, a, b);
    if (def.kind == JointKind::path) def.path = random_path(seed)->id();
    if (def.kind == JointKind::ratchet) def.ratio = Number::from_integer(random.between(2, 1000));
    if (chance(random, 2)) def.linear[0].mode = AxisMode::free;
    for (AngularAxis& axis : def.angular)
      if (def.kind == JointKind::path && chance(random, 2)) axis.mode = AxisMode::locked;
    if (chance(random, 2)) def.angular[0].max_effort.raw = log_between(random, 1, 1LL << 50);
    (void)world.create_joint(def);
  }
  if (!chance(random, 8)) return;
  LinearAxis along{.mode = chance(random, 2) ? AxisMode::free : AxisMode::limited};
  along.lower = scenes::millimetres_long(random.between(-1000, 9000));
  along.upper = along.lower + scenes::millimetres_long(random.between(0, 9000));
  along.target = along.lower;
  if (chance(random, 2))
    along.hertz.raw = static_cast<std::int32_t>(log_between(random, 1, 1000LL << 20));
  along.max_effort.raw = chance(random, 2) ? log_between(random, 1, 1LL << 50) : 0;
  along.speed = SolverVelocity::from_integer(random.between(-100, 100));
  (void)world.apply(SetLinearAxis{any_joint(world, random), 0, along});
}

// A floor of panels of which some are off, in a third of all scenes. Draws its numbers apart.
void drive_panels(World& world, std::uint64_t seed) {
  Random gate(mix(seed ^ 0x70616e65));
  if (!chance(gate, 3)) return;
  Random random(mix(~seed ^ mix(world.tick() + 17)));
  const Shape shape = scenes::panels(k_panels, k_panels, 2000)->shape();
  if (world.tick() == 0) {
    BodyDef floor;
    floor.motion = static_cast<MotionType>(1 + random.below(2));
    floor.shape = shape;
    floor.position.y = scenes::millimetres(random.between(-2000, 1000));
    (void)world.create_body(floor);
  }
  if (!chance(random, 3)) return;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (body.is_null() || world.body(body).shape.asset != shape.asset) continue;
    const std::uint32_t group = random.below(k_panels * k_panels + 1);
    (void)world.apply(SetMeshGroup{body, group, chance(random, 2)});
  }
}

// A level of which groups are switched, in a third of all scenes. Draws its numbers apart.
void drive_level(World& world, std::uint64_t seed) {
  Random gate(mix(seed ^ 0x6c6576656c));
  if (!chance(gate, 3)) return;
  Random random(mix(~seed ^ mix(world.tick() + 19)));
  const Shape shape = random_level()->shape();
  if (world.tick() == 0) {
    BodyDef level;
    level.motion = static_cast<MotionType>(1 + random.below(2));
    level.shape = shape;
    level.position.y = scenes::millimetres(random.between(-2000, 1000));
    level.orientation = chance(random, 2) ? scenes::random_orientation(random) : Quat{};
    level.is_trigger = chance(random, 8);
    (void)world.create_body(level);
  }
  if (!chance(random, 3)) return;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (body.is_null() || world.body(body).shape.asset != shape.asset) continue;
    const std::uint32_t group = random.below(k_panels * k_panels + 1);
    const bool is_on = chance(random, 2);
    (void)world.apply(SetMeshGroup{body, group, is_on});
  }
}

}  // namespace

AssetPtr random_panels() {
  return scenes::panels(k_panels, k_panels, 2000);
}

namespace {

AssetPtr make_level() {
  std::array<CompoundChild, 3> children;
  children[0].asset = random_panels();
  children[1].asset = scenes::bowl(4_m, 1.5_m, 6, 12);
  for (CompoundChild* mesh : {&children[0], &children[1]})
    mesh->shape = mesh->asset->shape();
  children[1].position = {9_m, {}, {}};
  children[1].orientation = from_axis_angle(scenes::k_z_axis, 0.3_rad);
  children[2] = scenes::box_child({-6_m, -1_m, {}}, {1_m, 1_m, 3_m});
  return scenes::compound_of(children);
}

}  // namespace

AssetPtr random_level() {
  static const AssetPtr k_level = make_level();
  return k_level;
}

AssetPtr random_path(std::uint64_t seed) {
  Random random(mix(seed ^ 0x70617468));
  const bool closed = chance(random, 2);
  for (;;) {
    std::vector<PathPoint> points(static_cast<std::size_t>(random.between(3, 12)));
    const auto reach = static_cast<std::int32_t>(log_between(random, 200, 30'000));
    for (PathPoint& point : points) {
      for (int axis = 0; axis < 3; ++axis)
        point.position[axis] = scenes::millimetres_long(random.between(-reach, reach));
      const std::int32_t x = random.between(-100, 100), z = random.between(-100, 100);
      point.up = {Unit::from_ratio(x, 100), Unit::from_integer(1), Unit::from_ratio(z, 100)};
    }
    std::vector<Angle> banks;
    if (chance(random, 3))
      for (std::size_t i = 0; i < points.size(); ++i)
        banks.push_back(Angle::from_ratio(random.between(-300, 300), 100));
    if (const PathResult made = Path::build(points, banks, closed); made.ok()) return made.path;
  }
}

void drive_features(World& world, std::uint64_t seed) {
  drive_events(world, seed);
  drive_changes(world, seed);
  drive_rules(world, seed);
  drive_vehicles(world, seed);
  drive_turning_locks(world, seed);
  drive_tracks(world, seed);
  drive_panels(world, seed);
  drive_level(world, seed);
  drive_terrain(world, seed);
}

}  // namespace lockstone::fuzz
