// Scenes of convex polyhedra, alone and joined.
#include <vector>

#include "tools/scenes/assets.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// Chunks, slivers, needles and regular ones in turn.
std::vector<AssetPtr> hull_assets(std::uint64_t seed) {
  Random random(mix(seed));
  std::vector<AssetPtr> assets;
  for (int i = 0; i < 4; ++i) {
    assets.push_back(random_hull(random, {0.45_m, 0.35_m, 0.4_m}, 8 + 12 * i));
    assets.push_back(random_hull(random, {0.6_m, 0.05_m, 0.2_m}, 10 + i));
    assets.push_back(random_hull(random, {0.08_m, 0.5_m, 0.07_m}, 8));
    assets.push_back(random_hull(random, {0.3_m, 0.3_m, 0.3_m}, 4));
  }
  assets.push_back(wedge(0.4_m, 0.25_m, 0.3_m));
  assets.push_back(prism(6, 0.3_m, 0.4_m));
  assets.push_back(prism(3, 0.35_m, 0.25_m));
  assets.push_back(prism(12, 0.4_m, 0.1_m));
  return assets;
}

void build_hulls(World& world, std::uint64_t seed, const SceneValues& values) {
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = Shape::half_space();
  add(world, ground);
  const std::vector<AssetPtr> assets = hull_assets(seed);
  Random random(mix(seed ^ 1));
  for (int i = 0; i < values[0]; ++i) {
    const std::int32_t x = i % 4 * 1300 - 1950 + random.between(-100, 100);
    const std::int32_t z = i / 4 % 4 * 1300 - 1950 + random.between(-100, 100);
    BodyDef def = loose(assets[static_cast<std::size_t>(i) % assets.size()]->shape(),
                        {millimetres(x), millimetres(800 + i / 16 * 1200), millimetres(z)});
    def.orientation = random_orientation(random);
    add(world, def);
  }
}

enum : std::size_t { k_chair, k_table, k_dumbbell, k_hammer, k_axe };

std::vector<AssetPtr> compound_assets(std::uint64_t) {
  return {chair(), table(), dumbbell(), hammer(), axe()};
}

// A table, a table on it and a chair on top; chairs in a row beside them.
void add_furniture(World& world, std::span<const AssetPtr> assets) {
  add(world, loose(assets[k_table]->shape(), {{}, {}, {}}));
  add(world, loose(assets[k_table]->shape(), {{}, 0.78_m, {}}));
  add(world, loose(assets[k_chair]->shape(), {-0.3_m, 1.56_m, {}}));
  for (int i = 0; i < 4; ++i) {
    BodyDef def = loose(assets[k_chair]->shape(), {millimetres(i * 700 - 1050), {}, 1.8_m});
    def.orientation = from_axis_angle(k_y_axis, Angle::from_ratio(i, 4));
    add(world, def);
  }
}

void add_tools(World& world, std::span<const AssetPtr> assets) {
  for (int i = 0; i < 3; ++i) {
    BodyDef def = loose(assets[k_hammer]->shape(),
                        {millimetres(i * 500 + 100), millimetres(3000 + i * 800), 0.1_m});
    def.orientation = from_axis_angle(k_z_axis, Angle::from_ratio(i + 1, 2));
    add(world, def);
  }
  BodyDef thrown = loose(assets[k_axe]->shape(), {-4.5_m, 1.2_m, 1.8_m});
  thrown.velocity = {7_mps, 1_mps, {}};
  thrown.angular_velocity = {{}, {}, -6_rps};
  add(world, thrown);
}

// Layers of three dumbbells, each square to the one below, and one that drops onto them.
void add_dumbbells(World& world, std::span<const AssetPtr> assets) {
  for (int i = 0; i < 9; ++i) {
    const bool crosswise = i / 3 % 2 != 0;
    const std::int32_t aside = i % 3 * 520 - 520;
    BodyDef def = loose(assets[k_dumbbell]->shape(),
                        {millimetres(3500 + (crosswise ? aside : 0)),
                         millimetres(250 + i / 3 * 500), millimetres(crosswise ? 0 : aside)});
    if (crosswise) def.orientation = from_axis_angle(k_y_axis, 1.5707963_rad);
    add(world, def);
  }
  BodyDef falling = loose(assets[k_dumbbell]->shape(), {3.6_m, 4_m, 0.1_m});
  falling.orientation = from_axis_angle(k_z_axis, 1.2_rad);
  add(world, falling);
}

void build_compounds(World& world, std::uint64_t seed) {
  const std::vector<AssetPtr> assets = compound_assets(seed);
  add_ground(world, 12_m);
  add_furniture(world, assets);
  add_tools(world, assets);
  add_dumbbells(world, assets);
}

}  // namespace

constinit const Scene k_hulls{.name = "hulls",
                              .description = "chunks, slivers and needles drop onto a half-space",
                              .golden_ticks = 300,
                              .define = small_world,
                              .builder = build_hulls,
                              .assets = hull_assets,
                              .own_parameters = {{{"bodies", 48, 1, 960}}}};
constinit const Scene k_compounds{.name = "compounds",
                                  .description = "furniture, hammers, an axe and dumbbells",
                                  .golden_ticks = 300,
                                  .define = small_world,
                                  .builder = build_compounds,
                                  .assets = compound_assets};

}  // namespace lockstone::scenes
