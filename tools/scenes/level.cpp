// One static body of meshes, boxes and hulls: bodies roll over its seams, a panel opens, bullets
// strike.
#include <array>
#include <vector>

#include "tools/scenes/assets.h"
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint32_t k_panels_a_side = 6, k_body = 1;  // the body's index, after the ground

CompoundChild child_of(const AssetPtr& asset, const Point& position, const Quat& turn = {}) {
  CompoundChild child;
  child.asset = asset;
  child.shape = asset->shape();
  child.position = position;
  child.orientation = turn;
  return child;
}

// A floor of 12 m whose panels are groups, a valley beside it, a bank of boxes flush with the floor
// on its other side, walls of another mesh, pillars and a ramp.
AssetPtr level() {
  const AssetPtr floor = panels(k_panels_a_side, k_panels_a_side, 2000);
  const std::array<Point, 5> profile{{{6_m, 0_m, {}},
                                      {8_m, -0.4_m, {}},
                                      {10_m, -0.2_m, {}},
                                      {12_m, 0.9_m, {}},
                                      {13_m, 2.5_m, {}}}};
  const AssetPtr wall = wall_mesh(6_m, 1_m), pillar = prism(7, 0.5_m, 0.8_m);
  const AssetPtr ramp = wedge(1.5_m, 0.5_m, 1.5_m);
  std::vector<CompoundChild> children{
      child_of(floor, {}), child_of(extruded(profile, 6_m, 6), {}),
      child_of(wall, {3_m, 1_m, 6_m}, from_axis_angle(k_y_axis, -1.5708_rad)),
      child_of(wall, {3_m, 1_m, -6_m}, from_axis_angle(k_y_axis, 1.5708_rad))};
  for (int i = 0; i < 3; ++i)
    children.push_back(
        box_child({-7_m, -0.5_m, Length::from_integer(4 * i - 4)}, {1_m, 0.5_m, 2_m}));
  for (int i = 0; i < 3; ++i)
    children.push_back(child_of(pillar, {-3_m, 0.8_m, Length::from_integer(3 * i - 3)}));
  children.push_back(child_of(ramp, {-8.5_m, 0.5_m, {}}));
  children[1].surface = Surface{0.1_r, {}};
  return compound_of(children);
}

std::vector<AssetPtr> level_assets(std::uint64_t) {
  return {level()};
}

WorldDef level_world() {
  WorldDef def = small_world();
  def.terrain_tile_capacity = 8;
  return def;
}

void add_runners(World& world, Random& random) {
  for (int i = 0; i < 24; ++i) {
    const std::int32_t size = random.between(150, 300), speed = random.between(4, 9);
    const Length half = millimetres_long(size);
    const Shape shape = i % 4 == 0   ? Shape::sphere(half)
                        : i % 4 == 1 ? Shape::box(half, half, half)
                        : i % 4 == 2 ? Shape::capsule(half, half / 2)
                                     : Shape::cylinder(half / 2, half);
    BodyDef def =
        loose(shape, {millimetres(-7600 + i % 3 * 600), millimetres(3020 + size + i % 2 * 700),
                      millimetres(i / 3 * 1300 - 4550)});
    def.velocity.x = Velocity::from_integer(speed);
    def.material.friction = 0.1_r;
    add(world, def);
  }
}

void build_level(World& world, std::uint64_t seed) {
  add_ground(world, 16_m);
  add(world, fixed(level_assets(seed)[0]->shape(), {{}, 3_m, {}}));
  Random random(mix(seed));
  add_runners(world, random);
}

// Panels open under the bodies, one in ten ticks, and bullets are shot at walls and pillars.
void drive_level(World& world, std::uint64_t) {
  const std::uint64_t tick = world.tick();
  if (tick >= 100 && tick < 220 && tick % 10 == 0) {
    const auto group = static_cast<std::uint32_t>((tick - 100) / 10 * 11 % 36);
    order(world, SetMeshGroup{world.body_at(k_body), group, false});
  }
  if (tick % 40 != 20) return;
  const Velocity speed = tick % 80 == 20 ? 150_mps : -150_mps;
  const bool at_wall = tick % 160 < 80;
  BodyDef bullet = loose(Shape::sphere(0.05_m),
                         {2_m, 4_m, millimetres(at_wall ? 0 : static_cast<int>(tick) * 4)});
  bullet.velocity = at_wall ? Vec3<Velocity>{{}, {}, speed} : Vec3<Velocity>{-150_mps, {}, {}};
  add(world, bullet);
}

}  // namespace

constinit const Scene k_level{
    .name = "level",
    .description = "a level of meshes, boxes and hulls in one body; panels of it open",
    .golden_ticks = 300,
    .define = level_world,
    .builder = build_level,
    .drive = drive_level,
    .assets = level_assets};

}  // namespace lockstone::scenes
