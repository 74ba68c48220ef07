// Scenes at rest and piles that come to rest.
#include <algorithm>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

void build_stack(World& world, std::uint64_t, const SceneValues& values) {
  add_ground(world, 10_m);
  add_stack(world, {}, values[0]);
}

void build_pyramid(World& world, std::uint64_t, const SceneValues& values) {
  const int rows = values[0];
  add_ground(world, millimetres_long(std::max(12000, rows * 600)));
  const Shape box = Shape::box(0.5_m, 0.5_m, 0.5_m);
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      const int left_mm = -(rows - row - 1) * 525;
      add(world, loose(box, {millimetres(left_mm + i * 1050), millimetres(500 + row * 1000), {}}));
    }
  }
}

// Its contacts have no impulses yet.
void build_wall(World& world, std::uint64_t, const SceneValues& values) {
  const int rows = values[0];
  add_ground(world, millimetres_long(std::max(30000, rows * 1000)));
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      add(world, loose(Shape::box(0.5_m, 0.5_m, 0.5_m),
                       {millimetres(1000 * i + 500 * row), millimetres(500 + row * 1000), {}}));
}

// Half a million metres from the origin, a stack stands as it does at the origin.
void build_far(World& world, std::uint64_t, const SceneValues& values) {
  const Vec3<Position> place{500000_m, {}, -500000_m};
  add(world, fixed_box(place + Vec3<Position>{{}, -0.5_m, {}}, {10_m, 0.5_m, 10_m}));
  add_stack(world, place, values[0]);
}

void add_pit(World& world) {
  add_ground(world, 6_m);
  for (const int side : {-1, 1}) {
    add(world, fixed_box({millimetres(side * 3250), 1_m, {}}, {0.25_m, 1_m, 3.5_m}));
    add(world, fixed_box({{}, 1_m, millimetres(side * 3250)}, {3_m, 1_m, 0.25_m}));
  }
}

void build_pile(World& world, std::uint64_t seed, const SceneValues& values) {
  add_pit(world);
  Random random(mix(seed));
  for (int i = 0; i < values[0] * 16; ++i) {
    const int column = i % 16;
    const std::int32_t x = -2250 + column % 4 * 1500 + random.between(-200, 200);
    const std::int32_t z = -2250 + column / 4 * 1500 + random.between(-200, 200);
    BodyDef def = loose(random_shape(random),
                        {millimetres(x), millimetres(1200 + i / 16 * 1500), millimetres(z)});
    def.orientation = random_orientation(random);
    def.material.density = Density::from_integer(random.between(200, 2000));
    add(world, def);
  }
}

}  // namespace

constinit const Scene k_stack{.name = "stack",
                              .description = "ten boxes on top of each other",
                              .golden_ticks = 240,
                              .define = small_world,
                              .builder = build_stack,
                              .own_parameters = {{{"boxes", 10, 1, 40}}}};
constinit const Scene k_pyramid{.name = "pyramid",
                                .description = "55 boxes in ten rows",
                                .golden_ticks = 180,
                                .define = small_world,
                                .builder = build_pyramid,
                                .own_parameters = {{{"rows", 10, 1, 60}}}};
constinit const Scene k_wall{.name = "wall",
                             .description = "253 boxes in 22 rows, put on each other",
                             .golden_ticks = 60,
                             .define = small_world,
                             .builder = build_wall,
                             .own_parameters = {{{"rows", 22, 1, 60}}}};
constinit const Scene k_far{.name = "far",
                            .description = "ten boxes stand 700 km from the origin",
                            .golden_ticks = 240,
                            .define = small_world,
                            .builder = build_far,
                            .own_parameters = {{{"boxes", 10, 1, 40}}}};
constinit const Scene k_pile{.name = "pile",
                             .description = "96 spheres, capsules and boxes drop into a pit",
                             .golden_ticks = 200,
                             .define = small_world,
                             .builder = build_pile,
                             .own_parameters = {{{"layers", 6, 1, 120}}}};

}  // namespace lockstone::scenes
