// A floor of panels that open in turn under bodies at rest, and close again.
#include <array>
#include <vector>

#include <lockstone/terrain.h>

#include "tools/scenes/assets.h"
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint32_t k_panels_a_side = 8, k_floor = 1;  // the body's index, after the ground
constexpr std::int32_t k_panel_mm = 1500;

std::vector<AssetPtr> trapdoor_assets(std::uint64_t) {
  return {panels(k_panels_a_side, k_panels_a_side, k_panel_mm)};
}

WorldDef trapdoor_world() {
  WorldDef def = small_world();
  def.terrain_tile_capacity = 8;
  return def;
}

void build_trapdoors(World& world, std::uint64_t seed) {
  add_ground(world, 12_m);
  BodyDef floor = fixed(trapdoor_assets(seed)[0]->shape(), {{}, 3_m, {}});
  add(world, floor);
  Random random(mix(seed));
  for (int i = 0; i < 64; ++i) {
    const std::int32_t size = random.between(150, 350);
    const Length half = millimetres_long(size);
    const Vec3<Position> at{millimetres(i % 8 * 1500 - 5250), millimetres(3000 + size + 5),
                            millimetres(i / 8 * 1500 - 5250)};
    const Shape shape = i % 3 == 0   ? Shape::sphere(half)
                        : i % 3 == 1 ? Shape::box(half, half, half)
                                     : Shape::capsule(half, half / 2);
    BodyDef def = loose(shape, at);
    if (i % 3 == 2) def.orientation = from_axis_angle(k_x_axis, 1.5708_rad);
    add(world, def);
  }
}

// One panel in each five ticks, on a way through all of them; it closes after a second and a half.
void drive_trapdoors(World& world, std::uint64_t) {
  constexpr std::uint64_t k_first = 60, k_open_for = 90;
  const auto turn = [&](std::uint64_t tick, bool is_on) {
    if (tick < k_first || (tick - k_first) % 5 != 0) return;
    const auto group = static_cast<std::uint32_t>((tick - k_first) / 5 * 27 % 64);
    order(world, SetMeshGroup{world.body_at(k_floor), group, is_on});
  };
  turn(world.tick(), false);
  if (world.tick() >= k_open_for) turn(world.tick() - k_open_for, true);
}

}  // namespace

constinit const Scene k_trapdoors{
    .name = "trapdoors",
    .description = "panels of a floor open in turn under bodies at rest, and close",
    .golden_ticks = 300,
    .define = trapdoor_world,
    .builder = build_trapdoors,
    .drive = drive_trapdoors,
    .assets = trapdoor_assets};

}  // namespace lockstone::scenes
