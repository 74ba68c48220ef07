#include "tools/arena/level.h"

#include <lockstone/literals.h>

#include "tools/arena/integers.h"
#include "tools/arena/rules.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

using namespace lockstone::literals;

constexpr Vec3<Unit> k_z_axis{{}, {}, Unit::from_integer(1)};

BodyHandle add(World& world, const BodyDef& def) {
  Result<BodyHandle> body = world.create_body(def);
  LKS_CHECK(body.ok());  // the capacities cover the level
  (void)world.set_name(body.value(), Tag::unpack(def.user_data).name());
  return body.value();
}

BodyDef scenery(const Shape& shape, const Vec3<Position>& position) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = shape;
  def.position = position;
  def.filter.category = k_scenery_bit;
  def.user_data = Tag{Kind::scenery}.pack();
  return def;
}

void add_ramp(World& world, const Vec3<Position>& position, Angle tilt) {
  BodyDef ramp = scenery(Shape::box(3.2_m, 0.25_m, 2_m), position);
  ramp.orientation = from_axis_angle(k_z_axis, tilt);
  add(world, ramp);
}

// Walls stand on the two long sides; on the goals' sides one can fall off.
void add_ground(World& world) {
  add(world, scenery(Shape::box(20_m, 0.5_m, 20_m), {{}, -0.5_m, {}}));
  add(world, scenery(Shape::box(20_m, 0.75_m, 0.25_m), {{}, 0.75_m, 20.25_m}));
  add(world, scenery(Shape::box(20_m, 0.75_m, 0.25_m), {{}, 0.75_m, -20.25_m}));
  for (const Position side : {Position(-19.75_m), Position(19.75_m)}) {
    for (const Position end : {Position(-14_m), Position(14_m)}) {
      add(world, scenery(Shape::box(0.25_m, 0.5_m, 5.5_m), {side, 0.5_m, end}));
    }
  }
}

void add_hill(World& world) {
  add(world, scenery(Shape::box(3_m, 0.75_m, 3_m), {{}, 0.75_m, {}}));
  // A slope of 0.25 rad whose upper edge meets the hill's.
  add_ramp(world, {5.85_m, 0.465_m, {}}, -0.25_rad);
  add_ramp(world, {-5.85_m, 0.465_m, {}}, 0.25_rad);
}

BodyDef zone(Kind kind, std::uint16_t number, const Shape& shape, const Vec3<Position>& position) {
  BodyDef def = scenery(shape, position);
  def.is_trigger = true;
  def.filter = {.category = k_zone_bit, .mask = k_player_bit | k_loose_bit};
  def.user_data = Tag{kind, number}.pack();
  return def;
}

void add_zones(World& world, Level& level) {
  const Shape goal = Shape::box(1.25_m, 1_m, 4_m);
  level.goals[0] = add(world, zone(Kind::goal, 0, goal, {-18.25_m, 1_m, {}}));
  level.goals[1] = add(world, zone(Kind::goal, 1, goal, {18.25_m, 1_m, {}}));
  level.hill = add(world, zone(Kind::hill, 0, Shape::box(2_m, 1_m, 2_m), {{}, 2.5_m, {}}));
}

void add_machines(World& world, Level& level) {
  BodyDef bar = scenery(Shape::box(4.5_m, 0.3_m, 0.25_m), {{}, 0.45_m, -13_m});
  bar.motion = MotionType::kinematic;
  bar.angular_velocity = {{}, 1.2_rps, {}};
  bar.user_data = Tag{Kind::bar}.pack();
  level.bar = add(world, bar);

  BodyDef ferry = scenery(Shape::box(1.75_m, 0.2_m, 1.75_m), {-11_m, 0.35_m, 4_m});
  ferry.motion = MotionType::kinematic;
  ferry.material.friction = 0.8_r;
  ferry.user_data = Tag{Kind::ferry}.pack();
  level.ferry = add(world, ferry);
}

void add_buggy(World& world, Level& level) {
  level.buggy = add(world, buggy_def());
  order(world, SetVehicle{level.buggy, buggy_wheels()});
}

Shape loose_shape(Kind kind, Random& random) {
  const Length size = millimetres_long(random.between(280, 480));
  const Length height = millimetres_long(random.between(280, 420));
  if (kind == Kind::ball) return Shape::sphere(size);
  if (kind == Kind::barrel) return Shape::capsule(height - Length(0.05_m), size - Length(0.1_m));
  return Shape::box(size, height, size);
}

BodyDef loose_body(Kind kind, std::uint16_t number, Random& random) {
  BodyDef def;
  def.shape = loose_shape(kind, random);
  def.orientation = from_axis_angle({{}, Unit::from_integer(1), {}},
                                    Angle::from_ratio(random.between(-314, 314), 100));
  def.material.density = Density::from_integer(random.between(60, 140));
  def.material.friction = kind == Kind::ball ? Coefficient(0.4_r) : Coefficient(0.6_r);
  def.material.restitution = kind == Kind::ball ? Coefficient(0.5_r) : Coefficient{};
  def.angular_damping = 0.2_rps;
  def.filter.category = k_loose_bit;
  def.user_data = Tag{kind, number}.pack();
  return def;
}

// Cells of 2 m on a grid of 18 × 18, layer over layer; those above hill, ramps, bar and spawn
// points stay free. 7 is coprime to 324, so that the cells are used evenly.
Vec3<Position> loose_position(std::uint32_t cell, Random& random) {
  constexpr std::uint32_t k_side = 18;
  const std::uint32_t place = cell * 7 % (k_side * k_side);
  const std::int32_t layer = static_cast<std::int32_t>(cell / (k_side * k_side));
  const auto along = static_cast<std::int32_t>(place % k_side) * 2000 - 17'000;
  const auto across = static_cast<std::int32_t>(place / k_side) * 2000 - 17'000;
  return {millimetres(along + random.between(-300, 300)), millimetres(700 + layer * 1500),
          millimetres(across + random.between(-300, 300))};
}

bool is_reserved(const Vec3<Position>& position) {
  const Position x = abs(position.x), z = abs(position.z);
  const bool hill = x < 9.8_m && z < 4.2_m;
  const bool bar = x < 5.5_m && abs(position.z + 13_m) < 5.5_m;
  const bool ferry = abs(position.x + 11_m) < 2.6_m && z < 7_m;
  const bool goal = x > 15.8_m && z < 5_m;
  const bool garage = abs(position.x - 13_m) < 3_m && abs(position.z - 15_m) < 2.5_m;
  return hill || bar || ferry || goal || garage;
}

void add_loose_bodies(World& world, Level& level, const ArenaConfig& config, Random& random) {
  level.loose.reserve(config.loose_bodies);
  for (std::uint32_t cell = 0; level.loose.size() < config.loose_bodies; ++cell) {
    const Vec3<Position> position = loose_position(cell, random);
    if (is_reserved(position)) continue;
    const auto number = static_cast<std::uint16_t>(level.loose.size());
    const auto kind = static_cast<Kind>(static_cast<unsigned>(Kind::crate) + number % 3U);
    BodyDef def = loose_body(kind, number, random);
    def.position = position;
    level.loose.push_back(add(world, def));
  }
}

void add_players(Arena& arena) {
  for (std::size_t slot = 0; slot < arena.config.players; ++slot) {
    BodyDef def;
    def.motion = MotionType::kinematic;
    def.shape = character_def().shape;
    def.position = spawn_point(slot);
    def.filter = filter_on_foot(slot);
    def.user_data = Tag{Kind::player, static_cast<std::uint16_t>(slot)}.pack();
    PlayerRecord& player = arena.state.players[slot];
    player.body = add(arena.world, def);
    const Vec3<Position> place = def.position;
    player.yaw = yaw_of(-(place.x.raw >> 20), -(place.z.raw >> 20));  // towards the middle
  }
}

}  // namespace

WorldDef world_def(const ArenaConfig& config) {
  WorldDef def;
  def.body_capacity = 32U + config.loose_bodies + config.players +
                      config.players * std::uint32_t{k_shots_per_player};
  def.pair_capacity = def.body_capacity * 16;
  def.contact_capacity = def.body_capacity * 8;
  def.vehicle_capacity = config.variant == Variant::yard ? 1 : 0;
  return def;
}

BodyDef buggy_def() {
  BodyDef def;
  def.shape = Shape::box(1.1_m, 0.22_m, 0.5_m);
  def.position = {13_m, 0.75_m, 15_m};
  def.orientation = from_axis_angle({{}, Unit::from_integer(1), {}}, 3.1415926_rad);
  def.mass.mass = 350_kg;
  def.material.friction = 0.3_r;
  def.events.hit_speed = 3_mps;
  def.filter.category = k_buggy_bit;
  def.user_data = Tag{Kind::buggy}.pack();
  return def;
}

VehicleDef buggy_wheels() {
  VehicleDef def = make_car(1.5_m, 0.6_m, 0.05_m, Torque::from_integer(120));
  for (Axle& axle : std::span(def.axles).first(2)) {
    axle.travel = 0.3_m;
    axle.frequency = Number::from_ratio(18, 10);
    axle.drive = Unit::from_integer(1);
    axle.brake = Torque::from_integer(500);
  }
  def.cast = WheelCast::sphere;
  def.mask = k_scenery_bit;
  return def;
}

Vec3<Position> spawn_point(std::size_t slot) {
  // Rows of eight beyond the hill's ends of the field, each further two behind the ones before.
  constexpr std::size_t k_pair_of_rows = 16;
  const auto place = static_cast<std::int32_t>(slot % k_pair_of_rows / 2);
  const std::int32_t along = (place % 2 == 0 ? 1 : -1) * (1250 + place / 2 * 2500);
  const std::int32_t across = 7000 + static_cast<std::int32_t>(slot / k_pair_of_rows) * 2500;
  return {millimetres(along), millimetres(4000), millimetres(slot % 2 == 0 ? across : -across)};
}

Arena build_arena(const ArenaConfig& config, BroadPhaseKind broad_phase) {
  WorldDef def = world_def(config);
  def.broad_phase = broad_phase;
  Result<World> world = World::create(def);
  LKS_CHECK(world.ok());
  Arena arena{config, std::move(world).value(), {}, {}};
  Random random(mix(config.seed));
  add_ground(arena.world);
  add_zones(arena.world, arena.level);
  if (config.variant == Variant::yard) {
    add_hill(arena.world);
    add_machines(arena.world, arena.level);
    add_buggy(arena.world, arena.level);
  }
  add_loose_bodies(arena.world, arena.level, config, random);
  add_players(arena);
  arena.state.game.random = random.state();
  return arena;
}

}  // namespace lockstone::arena
