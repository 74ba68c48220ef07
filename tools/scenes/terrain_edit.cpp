// Craters are dug under bodies at rest, a bank is raised under others, and a hole opens.
#include <array>
#include <vector>

#include <lockstone/terrain.h>

#include "tools/scenes/assets.h"
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr int k_flat_samples = 41, k_flat_cell_mm = 500,
              k_flat_half_mm = (k_flat_samples - 1) * k_flat_cell_mm / 2;
constexpr std::uint64_t k_ground = 0x7e22a1;  // user data of the ground

AssetPtr flat_field() {
  const std::vector<Length> heights(std::size_t{k_flat_samples} * k_flat_samples);
  HeightFieldDef def;
  def.columns = def.rows = k_flat_samples;
  def.origin = {millimetres_long(-k_flat_half_mm), {}, millimetres_long(-k_flat_half_mm)};
  def.cell_x = def.cell_z = millimetres_long(k_flat_cell_mm);
  def.heights = heights;
  const HeightFieldResult made = HeightField::build(def);
  LKS_CHECK(made.ok());
  return made.height_field;
}

std::vector<AssetPtr> terrain_edit_assets(std::uint64_t) {
  return {flat_field()};
}

WorldDef terrain_edit_world() {
  WorldDef def = small_world();
  def.terrain_tile_capacity = 128;
  return def;
}

void build_terrain_edit(World& world, std::uint64_t seed) {
  BodyDef ground = fixed(terrain_edit_assets(seed)[0]->shape(), {});
  ground.user_data = k_ground;
  add(world, ground);
  add(world, fixed(Shape::half_space(), {{}, -3_m, {}}));  // catches bodies that fall through holes
  constexpr std::array<std::int32_t, 3> k_sizes{250, 300, 400};  // mm
  for (int i = 0; i < 36; ++i) {
    const Length size = millimetres_long(k_sizes[static_cast<std::size_t>(i / 6 % 3)]);
    const Shape shape = i % 3 == 0   ? Shape::box(size, size, size)
                        : i % 3 == 1 ? Shape::capsule(size, size / 2)
                                     : Shape::box(size, size / 2, size);
    add(world, loose(shape, {millimetres(i % 6 * 2600 - 6500), rounded<Position>(size) + 0.02_m,
                             millimetres(i / 6 * 2600 - 6500)}));
  }
}

BodyHandle ground_of(const World& world) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    if (const BodyHandle body = world.body_at(i);
        !body.is_null() && world.body(body).user_data == k_ground)
      return body;
  return {};
}

// Lowers (or raises) a round patch by a share of `depth` that falls to 0 at its rim.
void dig(World& world, BodyHandle ground, int column, int row, int radius, std::int32_t depth_mm) {
  const int side = 2 * radius - 1;
  std::vector<Length> heights;
  for (int j = 1 - radius; j < radius; ++j) {
    for (int i = 1 - radius; i < radius; ++i) {
      const int share = std::max(0, radius * radius - i * i - j * j);
      const auto sample = terrain_sample_of(world, ground, static_cast<std::uint32_t>(column + i),
                                            static_cast<std::uint32_t>(row + j));
      heights.push_back(sample->height - millimetres_long(depth_mm * share / (radius * radius)));
    }
  }
  order(world, SetHeights{.body = ground,
                          .column = static_cast<std::uint32_t>(column + 1 - radius),
                          .row = static_cast<std::uint32_t>(row + 1 - radius),
                          .columns = static_cast<std::uint32_t>(side),
                          .rows = static_cast<std::uint32_t>(side),
                          .heights = heights});
}

// A bank along x: two rows of samples, a little higher every time.
void raise_bank(World& world, BodyHandle ground, std::int32_t height_mm) {
  const std::vector<Length> heights(2 * 30, millimetres_long(height_mm));
  order(world,
        SetHeights{
            .body = ground, .column = 5, .row = 32, .columns = 30, .rows = 2, .heights = heights});
}

void open_hole(World& world, BodyHandle ground) {
  const std::vector<std::uint8_t> holes(3 * 3, 1);
  order(
      world,
      SetHeights{.body = ground, .column = 21, .row = 5, .columns = 4, .rows = 4, .holes = holes});
}

void drive_terrain_edit(World& world, std::uint64_t) {
  const std::uint64_t tick = world.tick();
  const BodyHandle ground = ground_of(world);
  if (tick == 60) dig(world, ground, 12, 12, 6, 1500);
  if (tick == 90) dig(world, ground, 28, 17, 5, 1200);
  if (tick == 110) dig(world, ground, 15, 22, 4, 900);
  if (tick >= 120 && tick < 180 && tick % 2 == 0)
    raise_bank(world, ground, static_cast<std::int32_t>(tick - 118) * 15);
  if (tick == 200) open_hole(world, ground);
}

}  // namespace

constinit const Scene k_terrain_edit{
    .name = "terrain-edit",
    .description = "craters under bodies at rest, a bank that rises, a hole that opens",
    .golden_ticks = 300,
    .define = terrain_edit_world,
    .builder = build_terrain_edit,
    .drive = drive_terrain_edit,
    .assets = terrain_edit_assets};

}  // namespace lockstone::scenes
