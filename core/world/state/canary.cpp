// A short built-in scene whose hash tells whether two builds compute the same.

#include <lockstone/literals.h>
#include <lockstone/world.h>

namespace lockstone {
namespace {

using namespace literals;

constexpr int k_canary_ticks = 48;

BodyDef falling(const Shape& shape, Position x, Position y) {
  BodyDef def;
  def.shape = shape;
  def.position = {x, y, {}};
  def.orientation = {0.1_r, 0.2_r, 0.3_r, 0.9_r};
  def.velocity = {-1.5_mps, -4_mps, 0.25_mps};
  def.angular_velocity = {3_rps, -2_rps, 1_rps};
  def.material.restitution = 0.3_r;
  return def;
}

void add(World& world, const BodyDef& def) {
  LKS_CHECK(world.create_body(def).ok());
}

}  // namespace

std::uint64_t canary_hash() {
  WorldDef def;
  def.body_capacity = 8;
  def.pair_capacity = 64;
  def.contact_capacity = 32;
  Result<World> created = World::create(def);
  World& world = created.value();
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = Shape::box(10_m, 1_m, 10_m);
  ground.position = {{}, -1_m, {}};
  add(world, ground);
  add(world, falling(Shape::sphere(0.3_m), 0.1_m, 0.8_m));
  add(world, falling(Shape::box(0.4_m, 0.3_m, 0.2_m), 0.3_m, 1.5_m));
  add(world, falling(Shape::capsule(0.3_m, 0.2_m), -0.2_m, 2.4_m));
  add(world, falling(Shape::box(0.2_m, 0.2_m, 0.5_m), 0.0_m, 3.2_m));
  for (int tick = 0; tick < k_canary_ticks; ++tick)
    (void)world.step();
  return world.hash().total;
}

}  // namespace lockstone
