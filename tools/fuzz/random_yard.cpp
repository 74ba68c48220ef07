#include "tools/fuzz/random_yard.h"

#include <algorithm>
#include <array>

#include <lockstone/vehicle.h>

#include "tools/fuzz/random_features.h"
#include "tools/fuzz/random_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::fuzz {
namespace {

using namespace lockstone::literals;
using arena::millimetres;
using arena::mix;
using arena::Random;

using Place = Vec3<Position>;

Velocity speed_between(Random& random, int low, int high) {
  return Velocity::from_ratio(random.between(100 * low, 100 * high), 100);
}

Place above(const Place& at, Random& random, std::int64_t height) {
  Place place = at;
  place.x += millimetres(random.between(-300, 300));
  place.y += millimetres(height);
  place.z += millimetres(random.between(-300, 300));
  return place;
}

void add_stack(World& world, const Place& at, Random& random) {
  scenes::add_stack(world, at, random.between(1, 6));
}

void add_pile(World& world, const Place& at, Random& random) {
  const int count = random.between(2, 10);
  for (int i = 0; i < count; ++i) {
    const Place place = above(at, random, 600 + 500 * i);
    BodyDef body = scenes::loose(scenes::random_shape(random), place);
    body.material.restitution = Coefficient::from_ratio(random.between(0, 2), 4);
    body.is_bullet = chance(random, 8);
    scenes::add(world, body);
  }
}

void add_doll(World& world, const Place& at, Random& random) {
  scenes::add_ragdoll(world, above(at, random, 1500));
}

// A box that moves or stands, and boxes on it.
void add_platform(World& world, const Place& at, Random& random) {
  BodyDef platform = scenes::loose(Shape::box(1_m, 0.1_m, 1_m), above(at, random, 300));
  platform.motion = MotionType::kinematic;
  if (chance(random, 2)) platform.velocity.x = speed_between(random, -1, 1);
  if (chance(random, 6)) platform.velocity.x = speed_between(random, -60, 60);
  scenes::add(world, platform);
  const int count = random.between(0, 3);
  for (int i = 0; i < count; ++i)
    scenes::add(world,
                scenes::loose(Shape::box(0.2_m, 0.2_m, 0.2_m), above(at, random, 700 + 450 * i)));
}

void add_trigger(World& world, const Place& at, Random& random) {
  BodyDef zone = scenes::fixed(Shape::sphere(1_m), at);
  zone.is_trigger = true;
  if (chance(random, 3)) {
    zone.motion = MotionType::kinematic;
    zone.velocity.z = speed_between(random, -3, 3);
  }
  scenes::add(world, zone);
  add_pile(world, at, random);
}

// Hung from the ground, from a kinematic body, or from nothing.
void add_chain(World& world, const Place& at, Random& random) {
  BodyDef hook = scenes::fixed_box(above(at, random, 3000), {0.1_m, 0.1_m, 0.1_m});
  if (chance(random, 2)) hook.motion = MotionType::kinematic;
  BodyHandle last = scenes::add(world, hook);
  const int links = random.between(1, 5);
  for (int i = 0; i < links; ++i) {
    Place place = hook.position;
    place.x += millimetres(400 * (i + 1));
    const BodyHandle link =
        scenes::add(world, scenes::loose(Shape::box(0.2_m, 0.1_m, 0.1_m), place));
    JointDef joint =
        JointDef::of(chance(random, 2) ? JointKind::ball : JointKind::hinge, last, link);
    joint.frame_a.position.x = 0.2_m;
    joint.frame_b.position.x = -0.2_m;
    if (chance(random, 8)) joint.break_force = Force::from_integer(random.between(1, 500));
    (void)world.create_joint(joint);
    last = link;
  }
}

VehicleDef random_vehicle(Random& random) {
  const Torque torque = Torque::from_integer(random.between(20, 400));
  const std::uint32_t kind = random.below(4);
  VehicleDef def = kind == 0   ? make_motorcycle(1.2_m, {}, torque)
                   : kind == 1 ? make_tank(1.4_m, 0.5_m, {}, torque)
                               : make_car(1.4_m, 0.5_m, {}, torque);
  for (Axle& axle : def.axles)
    axle.travel = arena::millimetres_long(random.between(50, 400));
  def.gearbox.automatic = chance(random, 2);
  def.cast = chance(random, 2) ? WheelCast::sphere : WheelCast::ray;
  return def;
}

// It stands next to others, whom its wheels roll over.
void add_vehicle(World& world, const Place& at, Random& random) {
  BodyDef chassis = scenes::loose(Shape::box(1_m, 0.2_m, 0.4_m), above(at, random, 900));
  chassis.mass.mass = Mass::from_integer(random.between(80, 1500));
  const BodyHandle body = scenes::add(world, chassis);
  (void)world.apply(SetVehicle{body, random_vehicle(random)});
  const int count = random.between(0, 3);
  for (int i = 0; i < count; ++i) {
    Place place = above(at, random, 150);
    place.x += millimetres(2000 + 700 * i);
    scenes::add(world, scenes::loose(Shape::box(0.15_m, 0.1_m, 0.15_m), place));
  }
}

VehicleControls random_controls(Random& random) {
  VehicleControls controls;
  controls.throttle = Unit::from_ratio(random.between(0, 100), 100);
  controls.brake = chance(random, 3) ? Unit::from_ratio(random.between(0, 100), 100) : Unit{};
  controls.handbrake = chance(random, 6) ? Unit::from_integer(1) : Unit{};
  controls.steer = Unit::from_ratio(random.between(-100, 100), 100);
  controls.gear = random.between(-1, 3);
  return controls;
}

using AddIsland = void (*)(World&, const Place&, Random&);
constexpr std::array<AddIsland, 10> k_islands{add_stack,   add_stack,    add_pile,    add_pile,
                                              add_doll,    add_platform, add_trigger, add_chain,
                                              add_vehicle, add_vehicle};

BodyDef random_newcomer(Random& random) {
  const Place at{millimetres(random.between(-12'000, 12'000)), 2_m,
                 millimetres(random.between(-12'000, 12'000))};
  BodyDef body = scenes::loose(scenes::random_shape(random), at);
  if (chance(random, 4)) body.motion = MotionType::static_body;
  return body;
}

}  // namespace

RandomYard::RandomYard(std::uint64_t seed, std::uint64_t index) : seed_(mix(seed) ^ mix(~index)) {}

World RandomYard::make() const {
  Random random(seed_);
  WorldDef def;
  def.body_capacity = 256;
  def.joint_capacity = 192;
  def.pair_capacity = 4096;
  def.vehicle_capacity = 16;
  def.contact_capacity = chance(random, 8) ? 100 : 2048;
  def.converged_contacts = chance(random, 4) ? 64 : 1024;
  def.sleep_ms = chance(random, 3) ? 0 : 250;
  if (chance(random, 4)) def.broad_phase = BroadPhaseKind::sweep_and_prune;
  World world = std::move(World::create(def).value());
  if (chance(random, 6))
    scenes::add(world, scenes::fixed(Shape::half_space(), {}));
  else
    scenes::add_ground(world, 40_m);
  const int side = random.between(2, 4), pitch = random.between(1500, 6000);
  for (int i = 0; i < side * side; ++i) {
    const Place at{millimetres(pitch * (i % side)), {}, millimetres(pitch * (i / side))};
    k_islands[random.below(k_islands.size())](world, at, random);
  }
  return world;
}

void RandomYard::drive(World& world) const {
  drive_events(world, seed_);
  drive_vehicles_on(world);
  Random random(mix(seed_ ^ mix(world.tick() + 2)));
  if (chance(random, 4)) (void)world.apply(push(world, random));
}

void RandomYard::drive_vehicles_on(World& world) const {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    Random random(mix(seed_ ^ mix((world.tick() << 8) + i)));
    if (!chance(random, 40)) continue;
    const BodyHandle body = world.body_at(i);
    if (!body.is_null() && vehicle_of(world, body))
      (void)world.apply(DriveVehicle{body, random_controls(random)});
  }
}

Command RandomYard::push(const World& world, Random& random) {
  const BodyHandle body = any_body(world, random);
  if (body.is_null()) return WakeBody{body};
  switch (random.below(24)) {
    case 0:
      return random_command(world, random);
    case 1:
      return DestroyBody{body};
    case 2:
      return CreateBody{random_newcomer(random)};
    case 3:
      return SleepBody{body};
    case 4:
      return WakeBody{body};
    case 5: {
      Place to = world.body(body).position;
      to.x += millimetres(random.between(-2000, 2000));
      return Teleport{body, to, world.body(body).orientation};
    }
    case 6:
      return SetVehicle{body, random_vehicle(random)};
    case 7:
    case 8:
      return DriveVehicle{body, random_controls(random)};
    default: {
      Vec3<Velocity> velocity = world.body(body).velocity;
      const int most = chance(random, 6) ? 40 : 4;
      velocity.x += speed_between(random, -most, most);
      velocity.y += speed_between(random, 0, most);
      velocity.z += speed_between(random, -most, most);
      return SetVelocity{body, velocity};
    }
  }
}

}  // namespace lockstone::fuzz
