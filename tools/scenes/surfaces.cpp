// Scenes on triangles: a terrain, and a bowl, stairs and a slide.
#include <array>
#include <vector>

#include "tools/scenes/assets.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// Terrain -----------------------------------------------------------------------------------------

constexpr int k_samples = 33;  // along each side
constexpr int k_cell_mm = 700;
constexpr int k_half_mm = (k_samples - 1) * k_cell_mm / 2;

std::int32_t wave_mm(int i, std::int32_t height_mm) {
  const std::int64_t share = arena::direction_of(static_cast<std::int16_t>(i)).z.raw;
  return static_cast<std::int32_t>(share * height_mm >> 30);
}

// A valley that falls towards +x, with hills in it, and rises at its end.
std::int32_t height_mm(int i, int j) {
  const int aside = j - k_samples / 2, beyond = i > 26 ? i - 26 : 0;
  return 5000 - i * 190 + aside * aside * 11 + beyond * beyond * 120 + wave_mm(i * 9000, 260) +
         wave_mm(j * 11000 + i * 3000, 240);
}

bool is_hole(int i, int j) {
  return (i >= 18 && i <= 20 && j >= 10 && j <= 12) || (i >= 23 && i <= 25 && j >= 17 && j <= 18);
}

// Ice on the side of lower z, rough ground on the other.
AssetPtr valley() {
  std::vector<Length> heights;
  std::vector<std::uint8_t> holes, surfaces;
  for (int j = 0; j < k_samples; ++j) {
    for (int i = 0; i < k_samples; ++i) {
      heights.push_back(millimetres_long(height_mm(i, j)));
      if (i + 1 == k_samples || j + 1 == k_samples) continue;
      holes.push_back(is_hole(i, j) ? 1 : 0);
      surfaces.push_back(j < k_samples / 2 ? 0 : 1);
    }
  }
  const std::array<Surface, 2> kinds{{{0.02_r, {}}, {0.9_r, {}}}};
  HeightFieldDef def;
  def.columns = def.rows = k_samples;
  def.origin = {millimetres_long(-k_half_mm), {}, millimetres_long(-k_half_mm)};
  def.cell_x = def.cell_z = millimetres_long(k_cell_mm);
  def.heights = heights;
  def.holes = holes;
  def.cell_surfaces = surfaces;
  def.surfaces = kinds;
  const HeightFieldResult made = HeightField::build(def);
  LKS_CHECK(made.ok());
  return made.height_field;
}

std::vector<AssetPtr> terrain_assets(std::uint64_t seed) {
  Random random(mix(seed));
  return {valley(), random_hull(random, {0.35_m, 0.3_m, 0.3_m}, 24), prism(6, 0.3_m, 0.35_m)};
}

Shape terrain_shape(std::span<const AssetPtr> assets, int i) {
  const std::array<Shape, 5> shapes{Shape::sphere(0.3_m), Shape::box(0.3_m, 0.2_m, 0.25_m),
                                    Shape::capsule(0.3_m, 0.2_m), assets[1]->shape(),
                                    assets[2]->shape()};
  return shapes[static_cast<std::size_t>(i) % shapes.size()];
}

void build_terrain(World& world, std::uint64_t seed) {
  constexpr int k_bodies = 40;
  const std::vector<AssetPtr> assets = terrain_assets(seed);
  add(world, fixed(assets[0]->shape(), {}));
  add(world, fixed(Shape::half_space(), {{}, -3_m, {}}));  // catches bodies that fall through holes
  Random random(mix(seed ^ 1));
  for (int i = 0; i < k_bodies; ++i) {
    const int column = 1 + i / 8 * 2, row = 5 + i % 8 * 3;
    BodyDef def = loose(terrain_shape(assets, i), {millimetres(column * k_cell_mm - k_half_mm),
                                                   millimetres(height_mm(column, row) + 900),
                                                   millimetres(row * k_cell_mm - k_half_mm)});
    def.orientation = random_orientation(random);
    add(world, def);
  }
}

// Meshes ------------------------------------------------------------------------------------------

// Eight steps down.
AssetPtr stairs() {
  constexpr int k_steps = 8;
  std::vector<Point> profile;
  for (int i = 0; i < k_steps; ++i) {
    const Length y = millimetres_long((k_steps - i) * 300);
    profile.push_back({millimetres_long(i * 500), y, {}});
    profile.push_back({millimetres_long(i * 500 + 500), y, {}});
  }
  profile.push_back({millimetres_long(k_steps * 500), {}, {}});
  profile.push_back({millimetres_long(k_steps * 500 + 3000), {}, {}});
  return extruded(profile, 1.2_m, 5);
}

// Down, level, and up a little at the end, in short pieces that leave many edges to cross.
AssetPtr slide() {
  constexpr int k_pieces = 30;
  std::vector<Point> profile;
  for (int i = 0; i <= k_pieces; ++i) {
    const int down = i < 12 ? 12 - i : 0, up = i > 24 ? i - 24 : 0;
    profile.push_back(
        {millimetres_long(i * 400), millimetres_long(400 + down * 200 + up * 100), {}});
  }
  return extruded(profile, 1_m, 6);
}

std::vector<AssetPtr> mesh_assets(std::uint64_t seed) {
  Random random(mix(seed));
  return {bowl(2.5_m, 1.8_m, 5, 16), stairs(), slide(),
          random_hull(random, {0.3_m, 0.25_m, 0.3_m}, 20), prism(5, 0.25_m, 0.3_m)};
}

void fill_bowl(World& world, const Vec3<Position>& place, std::span<const AssetPtr> assets) {
  for (int i = 0; i < 6; ++i) {
    const Vec3<Unit> out = arena::direction_of(static_cast<std::int16_t>(i * 10923));
    const Vec3<Position> offset{Position::from_raw(std::int64_t{out.x.raw} * 7),
                                Position::from_integer(2),
                                Position::from_raw(std::int64_t{out.z.raw} * 7)};
    const Shape shape = i % 3 == 0   ? Shape::sphere(0.25_m)
                        : i % 3 == 1 ? Shape::box(0.2_m, 0.2_m, 0.2_m)
                                     : assets[3]->shape();
    add(world, loose(shape, place + offset));
  }
}

void build_mesh(World& world, std::uint64_t seed) {
  const std::vector<AssetPtr> assets = mesh_assets(seed);
  add(world, fixed(Shape::half_space(), {}));
  const Vec3<Position> bowl_place{-5_m, 0.3_m, -1_m}, slide_place{-6_m, {}, 4_m};
  add(world, fixed(assets[0]->shape(), bowl_place));
  add(world, fixed(assets[1]->shape(), {-1_m, {}, -2_m}));
  BodyDef smooth = fixed(assets[2]->shape(), slide_place);
  smooth.material.friction = {};
  add(world, smooth);
  fill_bowl(world, bowl_place, assets);
  for (int i = 0; i < 3; ++i) {
    const Shape shape = i == 0   ? assets[4]->shape()
                        : i == 1 ? Shape::sphere(0.25_m)
                                 : assets[3]->shape();
    BodyDef def = loose(shape, {-0.7_m, 2.8_m, millimetres(i * 700 - 2700)});
    def.velocity = {1.5_mps, {}, {}};
    def.orientation = from_axis_angle(k_x_axis, 0.3_rad);
    add(world, def);
  }
  const Quat along_slope = from_axis_angle(k_z_axis, -0.4636476_rad);
  BodyDef ball = loose(Shape::sphere(0.25_m), slide_place + Vec3<Position>{0.5_m, 2.85_m, -0.5_m});
  add(world, ball);
  BodyDef box =
      loose(Shape::box(0.3_m, 0.2_m, 0.25_m), slide_place + Vec3<Position>{0.6_m, 2.74_m, 0.4_m});
  box.orientation = along_slope;
  add(world, box);
}

}  // namespace

constinit const Scene k_terrain{.name = "terrain",
                                .description = "40 bodies down a valley of ice and rock with holes",
                                .golden_ticks = 300,
                                .define = small_world,
                                .builder = build_terrain,
                                .assets = terrain_assets};
constinit const Scene k_mesh{.name = "mesh",
                             .description = "a bowl, stairs and a slide of triangles",
                             .golden_ticks = 300,
                             .define = small_world,
                             .builder = build_mesh,
                             .assets = mesh_assets};

}  // namespace lockstone::scenes
