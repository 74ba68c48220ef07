// Filters and triggers: which bodies meet, and which are only seen.
#include <array>
#include <vector>

#include "tools/scenes/assets.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

enum : std::size_t { k_chunk, k_barbell, k_funnel };

std::vector<AssetPtr> layer_assets(std::uint64_t seed) {
  Random random(mix(seed));
  return {random_hull(random, {0.8_m, 0.6_m, 0.7_m}, 20), dumbbell(), bowl(1.5_m, 0.8_m, 4, 12)};
}

// Each sieve lets two of the four categories pass: two kinds of balls stay on the uppermost, one on
// each of the others.
void add_sieves(World& world) {
  for (int floor = 0; floor < 3; ++floor) {
    BodyDef sieve = fixed_box({-6_m, millimetres(1000 + floor * 1200), {}}, {1.5_m, 0.1_m, 1.5_m});
    sieve.filter.mask = ~(std::uint32_t{2} << floor) & ~(std::uint32_t{2} << (floor + 1));
    add(world, sieve);
  }
  for (int i = 0; i < 12; ++i) {
    BodyDef ball = loose(Shape::sphere(0.25_m),
                         {millimetres(-6900 + i % 4 * 600), millimetres(4600 + i / 4 * 600),
                          millimetres(i * 700 % 1800 - 900)});
    ball.filter.category = std::uint32_t{2} << i % 4;
    add(world, ball);
  }
}

// Boxes in one place: those of group −1 overlap freely, those of group 1 meet though their masks
// say no, those of no group are parted by mask.
void add_groups(World& world) {
  for (int i = 0; i < 9; ++i) {
    const int kind = i % 3;
    BodyDef box = loose(Shape::box(0.4_m, 0.4_m, 0.4_m),
                        {millimetres(-2400 + kind * 1100), millimetres(500 + i / 3 * 900), {}});
    box.filter.group = kind - 1;
    box.filter.category = std::uint32_t{1} << (8 + i % 2);
    if (kind != 0) box.filter.mask = ~box.filter.category;
    add(world, box);
  }
}

std::vector<BodyDef> zones(std::span<const AssetPtr> assets) {
  const std::array<Shape, 6> shapes{
      Shape::sphere(0.7_m),     Shape::capsule(0.5_m, 0.4_m), Shape::box(0.6_m, 0.6_m, 0.6_m),
      assets[k_chunk]->shape(), assets[k_barbell]->shape(),   assets[k_funnel]->shape()};
  std::vector<BodyDef> result;
  for (const Shape& shape : shapes) {
    BodyDef zone = fixed(shape, {});
    zone.is_trigger = true;
    result.push_back(zone);
  }
  return result;
}

// Static zones of every bounded shape with a ball that falls through each; kinematic ones that
// sweep over a row of boxes; and one that moves among them with gravity off.
void add_zones(World& world, std::span<const AssetPtr> assets) {
  int i = 0;
  for (BodyDef zone : zones(assets)) {
    const Position x = millimetres(2000 + i % 3 * 2500), z = millimetres(i / 3 * 3500 - 3500);
    zone.position = {x, 2_m, z};
    add(world, zone);
    add(world, loose(Shape::sphere(0.2_m), {x + millimetres(450), 5_m, z}));
    if (zone.shape.kind != ShapeKind::mesh) {
      zone.motion = MotionType::kinematic;
      zone.position = {millimetres(1000 + i * 1500), 0.72_m, 7_m};
      zone.velocity = {{}, {}, -1.5_mps};
      add(world, zone);
      add(world, loose(Shape::box(0.3_m, 0.3_m, 0.3_m), {zone.position.x, 0.3_m, 3.6_m}));
    }
    ++i;
  }
}

// Everything below a slanting plane counts as under water.
void add_water(World& world) {
  BodyDef water = fixed(Shape::half_space(), {{}, 0.25_m, {}});
  water.orientation = from_axis_angle(k_z_axis, 0.02_rad);
  water.is_trigger = true;
  add(world, water);
}

void build_layers(World& world, std::uint64_t seed) {
  const std::vector<AssetPtr> assets = layer_assets(seed);
  add_ground(world, 14_m);
  add_sieves(world);
  add_groups(world);
  add_zones(world, assets);
  add_water(world);
}

}  // namespace

constinit const Scene k_layers{.name = "layers",
                               .description = "sieves, groups, and triggers of every shape",
                               .golden_ticks = 300,
                               .define = small_world,
                               .builder = build_layers,
                               .observe = count_in_triggers,
                               .assets = layer_assets};

}  // namespace lockstone::scenes
