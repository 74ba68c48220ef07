// Scenes of rounded boxes and hulls.
#include <vector>

#include <lockstone/hull.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// A die of half extent `half`, a fifth of it radius.
Shape die(Length half) {
  const Length core = half - half / 5;
  return Shape::rounded_box(core, core, core, half / 5);
}

// A stack of dice, one that spins on a corner, soaps that slide and roll down a slope, a row of
// dominoes, and a throw of dice.
void build_dice(World& world, std::uint64_t seed, const SceneValues& values) {
  add_ground(world, 20_m);
  for (int i = 0; i < 5; ++i)
    add(world, loose(die(0.4_m), {-4_m, millimetres(400 + 800 * i), -2_m}));
  BodyDef spinner = loose(die(0.4_m), {-2_m, 0.66_m, 1.5_m});
  spinner.orientation =
      multiply(from_axis_angle(k_x_axis, 0.6155_rad), from_axis_angle(k_z_axis, 0.7854_rad));
  spinner.angular_velocity = {{}, 25_rps, {}};
  add(world, spinner);
  BodyDef slope = fixed_box({3_m, 0.6_m, -3_m}, {2_m, 0.2_m, 1.5_m});
  slope.orientation = from_axis_angle(k_z_axis, 0.35_rad);
  add(world, slope);
  for (int i = 0; i < 3; ++i) {
    // The rounder, the sooner it rolls.
    const Length radius = millimetres_long(60 + 90 * i), core = millimetres_long(250) - radius;
    BodyDef soap = loose(Shape::rounded_box(core, core, 0.2_m, radius),
                         {4_m, 1.75_m, millimetres(-4000 + 1000 * i)});
    soap.orientation = from_axis_angle(k_z_axis, 0.35_rad);
    add(world, soap);
  }
  for (int i = 0; i < 8; ++i) {
    BodyDef domino = loose(Shape::rounded_box(0.06_m, 0.46_m, 0.21_m, 0.04_m),
                           {millimetres(-1000 + 450 * i), 0.5_m, 4_m});
    if (i == 0) domino.angular_velocity = {{}, {}, -2_rps};
    add(world, domino);
  }
  Random random(mix(seed));
  for (int i = 0; i < values[0]; ++i) {
    const Length half = millimetres_long(random.between(120, 260));
    const std::int64_t x = random.between(-500, 500), z = random.between(-500, 500);
    BodyDef thrown =
        loose(die(half), {millimetres(x), millimetres(800 + 450 * i), millimetres(z - 1000)});
    thrown.orientation = random_orientation(random);
    thrown.velocity = {1_mps, {}, {}};
    thrown.angular_velocity = {{}, {}, -5_rps};
    add(world, thrown);
  }
}

// Eight kinds of pebbles: hulls of few points with a radius.
std::vector<AssetPtr> pebbles(std::uint64_t /*seed*/) {
  Random random(mix(7));
  std::vector<AssetPtr> assets;
  for (int kind = 0; kind < 8; ++kind) {
    std::vector<Vec3<Length>> points;
    for (int i = 0; i < 7; ++i) {
      const std::int64_t x = random.between(-220, 220), y = random.between(-110, 110),
                         z = random.between(-160, 160);
      points.push_back({millimetres_long(x), millimetres_long(y), millimetres_long(z)});
    }
    const Length radius = millimetres_long(40 + 15 * kind);
    assets.push_back(Hull::build(points, HullOptions::rounded(radius)).hull);
  }
  return assets;
}

// A heap of pebbles between two walls, and stones that roll down a slope.
void build_pebbles(World& world, std::uint64_t seed, const SceneValues& values) {
  add_ground(world, 20_m);
  add(world, fixed_box({-1.2_m, 0.3_m, {}}, {0.2_m, 0.3_m, 1.4_m}));
  add(world, fixed_box({1.2_m, 0.3_m, {}}, {0.2_m, 0.3_m, 1.4_m}));
  BodyDef slope = fixed_box({4_m, 0.6_m, {}}, {2_m, 0.2_m, 1.5_m});
  slope.orientation = from_axis_angle(k_z_axis, 0.35_rad);
  add(world, slope);
  const AssetSet set(pebbles(seed));  // the world's own may have those of other scenes too
  const std::span<const AssetPtr> kinds = set.all();
  Random random(mix(seed));
  for (std::int64_t i = 0; i < values[0]; ++i) {
    const auto kind = static_cast<std::size_t>(i) % kinds.size();
    const std::int64_t x = random.between(-600, 600), z = random.between(-800, 800);
    const bool rolls = i % 5 == 4;
    BodyDef stone = loose(
        kinds[kind]->shape(),
        {millimetres(rolls ? 5000 : x), millimetres(rolls ? 1800 : 500 + 120 * i), millimetres(z)});
    stone.orientation = random_orientation(random);
    add(world, stone);
  }
}

}  // namespace

const Scene k_pebbles{.name = "pebbles",
                      .description = "hulls with rounded edges: a heap, and stones down a slope",
                      .golden_ticks = 240,
                      .define = small_world,
                      .builder = build_pebbles,
                      .assets = pebbles,
                      .own_parameters = {{{"stones", 40, 0, 400}}}};

const Scene k_dice{.name = "dice",
                   .description = "dice with rounded edges: stacked, spinning, rolling, thrown",
                   .golden_ticks = 240,
                   .define = small_world,
                   .builder = build_dice,
                   .own_parameters = {{{"thrown", 12, 0, 200}}}};

}  // namespace lockstone::scenes
