// Scenes to which something is done while they run.
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// Bodies are found again by their index: a scene that destroys nothing keeps the order of creation.
constexpr std::uint32_t k_platform_index = 1;
constexpr std::uint64_t k_platform_leg_ticks = 90;

void add_swept_balls(World& world) {
  for (int i = 0; i < 12; ++i) {
    const Position x = millimetres(4500 + i % 4 * 900);
    const Position z = millimetres(-1000 + i / 4 * 900);
    add(world, loose(Shape::sphere(0.35_m), {x, 0.35_m, z}));
  }
}

void build_kinematic(World& world, std::uint64_t) {
  add_ground(world, 15_m);
  BodyDef platform = fixed_box({-5_m, 1_m, {}}, {2_m, 0.2_m, 2_m});
  platform.motion = MotionType::kinematic;
  platform.material.friction = 1_r;
  add(world, platform);
  for (int i = 0; i < 3; ++i) {
    BodyDef box =
        loose(Shape::box(0.4_m, 0.4_m, 0.4_m), {millimetres(-6200 + i * 1200), 1.6_m, {}});
    box.material.friction = 0.8_r;
    add(world, box);
  }
  BodyDef bar = fixed_box({6_m, 0.4_m, -3.5_m}, {3_m, 0.25_m, 0.2_m});
  bar.motion = MotionType::kinematic;
  bar.angular_velocity = {{}, 1.5_rps, {}};
  add(world, bar);
  add_swept_balls(world);
}

// Half a leg to one end, then to and fro.
void drive_kinematic(World& world, std::uint64_t) {
  const std::uint64_t leg = (world.tick() + k_platform_leg_ticks / 2) / k_platform_leg_ticks;
  const Velocity speed = leg % 2 == 0 ? Velocity(1.5_mps) : Velocity(-1.5_mps);
  order(world, SetVelocity{world.body_at(k_platform_index), {{}, {}, speed}});
}

void build_trigger(World& world, std::uint64_t) {
  add_ground(world, 15_m);
  for (int i = 0; i < 3; ++i) {
    BodyDef zone = fixed_box({millimetres(i * 4000 - 4000), 1_m, {}}, {1_m, 1_m, 3_m});
    zone.is_trigger = true;
    add(world, zone);
  }
  for (int i = 0; i < 5; ++i) {
    const Shape shape = i % 2 == 0 ? Shape::sphere(0.4_m) : Shape::box(0.4_m, 0.4_m, 0.4_m);
    BodyDef body = loose(shape, {-9_m, 0.4_m, millimetres(i * 1100 - 2200)});
    body.velocity = {Velocity::from_integer(5 + i), {}, {}};
    add(world, body);
  }
}

void build_spawn(World& world, std::uint64_t) {
  add_ground(world, 8_m);
}

Vec3<Position> random_drop(Random& random) {
  const std::int32_t x = random.between(-4000, 4000);
  const std::int32_t z = random.between(-4000, 4000);
  const std::int32_t y = random.between(1000, 6000);
  return {millimetres(x), millimetres(y), millimetres(z)};
}

void spawn_one(World& world, Random& random) {
  const Shape shape = random_shape(random);
  BodyDef def = loose(shape, random_drop(random));
  def.orientation = random_orientation(random);
  def.velocity = {Velocity::from_integer(random.between(-4, 4)),
                  {},
                  Velocity::from_integer(random.between(-4, 4))};
  def.user_data = random.next();
  add(world, def);
}

// Any body but the ground, or null when the random slot is empty.
BodyHandle random_body(const World& world, Random& random) {
  if (world.body_limit() < 2) return {};
  return world.body_at(1 + random.below(world.body_limit() - 1));
}

void drive_spawn(World& world, std::uint64_t seed) {
  constexpr std::uint32_t k_most_bodies = 80;
  Random random(mix(seed ^ mix(world.tick())));
  const std::uint32_t choice = random.below(8);
  if (choice < 4 && world.body_count() < k_most_bodies) spawn_one(world, random);
  const BodyHandle body = random_body(world, random);
  if (body.is_null()) return;
  if (choice == 5) order(world, DestroyBody{body});
  if (choice == 6) order(world, Teleport{body, random_drop(random), random_orientation(random)});
}

}  // namespace

constinit const Scene k_kinematic{"kinematic",
                                  "a platform carries boxes, a bar sweeps balls",
                                  300,
                                  small_world,
                                  build_kinematic,
                                  drive_kinematic};
constinit const Scene k_trigger{"trigger",
                                "bodies cross three zones that count them",
                                240,
                                small_world,
                                build_trigger,
                                nullptr,
                                count_in_triggers};
constinit const Scene k_spawn{"spawn",     "bodies appear, vanish and jump at random",
                              300,         small_world,
                              build_spawn, drive_spawn};

}  // namespace lockstone::scenes
