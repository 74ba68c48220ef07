#include "tests/world/world_fixture.h"

#include <algorithm>
#include <cmath>

#include "tests/support/random.h"

namespace lockstone::test {

using namespace literals;

namespace {

WorldDef small_world(WorldDef def) {
  const WorldDef usual;
  const auto shrink = [&](std::uint32_t WorldDef::*capacity, std::uint32_t few) {
    if (def.*capacity == usual.*capacity) def.*capacity = std::min(usual.*capacity, few);
  };
  shrink(&WorldDef::pair_capacity, 64 + 8 * def.body_capacity);
  shrink(&WorldDef::contact_capacity, 64 + 2 * def.body_capacity);
  shrink(&WorldDef::joint_capacity, 16 + def.body_capacity / 4);
  return def;
}

}  // namespace

World make_world(WorldDef def, std::shared_ptr<const AssetSet> assets) {
  return std::move(World::create(small_world(def), std::move(assets))).value();
}

BodyHandle add(World& world, const BodyDef& def) {
  return world.create_body(def).value();
}

BodyHandle add_ground(World& world) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = Shape::box(50_m, 1_m, 50_m);
  def.position = {{}, -1_m, {}};
  return add(world, def);
}

BodyDef dynamic_body(const Shape& shape, Position x, Position y, Position z) {
  BodyDef def;
  def.shape = shape;
  def.position = {x, y, z};
  return def;
}

namespace {

Shape random_shape(Random& random) {
  const auto size = [&] {
    return Length::from_raw(static_cast<std::int32_t>(random.between(1 << 17, 1 << 19)));
  };
  switch (random.between(0, 2)) {
    case 0:
      return Shape::sphere(size());
    case 1: {  // one number a statement, or compilers differ
      const Length half_height = size();
      return Shape::capsule(half_height, size());
    }
    default: {
      const Length z = size(), y = size();
      return Shape::box(size(), y, z);
    }
  }
}

Unit random_unit(Random& random) {
  return Unit::from_raw(static_cast<std::int32_t>(random.between(-(1 << 29), 1 << 29)));
}

}  // namespace

void fill_with_random_bodies(World& world, std::uint64_t seed, int count) {
  Random random(seed);
  add_ground(world);
  for (int i = 0; i < count; ++i) {
    BodyDef def;
    def.shape = random_shape(random);
    def.position = {Position::from_ratio(random.between(-400, 400), 100),
                    Position::from_ratio(random.between(60, 800), 100),
                    Position::from_ratio(random.between(-400, 400), 100)};
    def.orientation = {random_unit(random), random_unit(random), random_unit(random), 1_r};
    def.velocity = {Velocity::from_ratio(random.between(-300, 300), 100),
                    {},
                    Velocity::from_ratio(random.between(-300, 300), 100)};
    def.angular_velocity = {AngularVelocity::from_ratio(random.between(-300, 300), 100), {}, {}};
    def.material.restitution = Unit::from_ratio(random.between(0, 60), 100);
    def.user_data = static_cast<std::uint64_t>(i);
    add(world, def);
  }
}

void step(World& world, int ticks) {
  for (int i = 0; i < ticks; ++i)
    (void)world.step();
}

std::vector<std::byte> save(const World& world, SnapshotKind kind) {
  std::vector<std::byte> bytes(world.snapshot_bytes_max(kind));
  bytes.resize(world.save(kind, bytes));
  return bytes;
}

namespace {
std::uint64_t g_clock_calls = 0;
}  // namespace

std::uint64_t counting_clock() {
  return ++g_clock_calls;
}

std::uint64_t clock_calls() {
  return g_clock_calls;
}

double metres(Position x) {
  return static_cast<double>(x.raw) / 4294967296.0;
}

double metres_per_second(Velocity v) {
  return std::ldexp(static_cast<double>(v.raw), -32);
}

}  // namespace lockstone::test
