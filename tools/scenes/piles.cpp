// Scenes at rest and piles that come to rest.
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

void build_stack(World& world, std::uint64_t) {
  add_ground(world, 10_m);
  add_stack(world, {}, 10);
}

void build_pyramid(World& world, std::uint64_t) {
  constexpr int k_rows = 10;
  add_ground(world, 12_m);
  const Shape box = Shape::box(0.5_m, 0.5_m, 0.5_m);
  for (int row = 0; row < k_rows; ++row) {
    for (int i = 0; i < k_rows - row; ++i) {
      const int left_mm = -(k_rows - row - 1) * 525;
      add(world, loose(box, {millimetres(left_mm + i * 1050), millimetres(500 + row * 1000), {}}));
    }
  }
}

// Its contacts have no impulses yet.
void build_wall(World& world, std::uint64_t) {
  constexpr int k_rows = 22;
  add_ground(world, 30_m);
  for (int row = 0; row < k_rows; ++row)
    for (int i = 0; i < k_rows - row; ++i)
      add(world, loose(Shape::box(0.5_m, 0.5_m, 0.5_m),
                       {millimetres(1000 * i + 500 * row), millimetres(500 + row * 1000), {}}));
}

// Half a million metres from the origin, a stack stands as it does at the origin.
void build_far(World& world, std::uint64_t) {
  const Vec3<Position> place{500000_m, {}, -500000_m};
  add(world, fixed_box(place + Vec3<Position>{{}, -0.5_m, {}}, {10_m, 0.5_m, 10_m}));
  add_stack(world, place, 10);
}

void add_pit(World& world) {
  add_ground(world, 6_m);
  for (const int side : {-1, 1}) {
    add(world, fixed_box({millimetres(side * 3250), 1_m, {}}, {0.25_m, 1_m, 3.5_m}));
    add(world, fixed_box({{}, 1_m, millimetres(side * 3250)}, {3_m, 1_m, 0.25_m}));
  }
}

void build_pile(World& world, std::uint64_t seed) {
  constexpr int k_layers = 6;
  add_pit(world);
  Random random(mix(seed));
  for (int i = 0; i < k_layers * 16; ++i) {
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

constinit const Scene k_stack{"stack", "ten boxes on top of each other", 240, small_world,
                              build_stack};
constinit const Scene k_pyramid{"pyramid", "55 boxes in ten rows", 180, small_world, build_pyramid};
constinit const Scene k_wall{"wall", "253 boxes in 22 rows, put on each other", 60, small_world,
                             build_wall};
constinit const Scene k_far{"far", "ten boxes stand 700 km from the origin", 240, small_world,
                            build_far};
constinit const Scene k_pile{"pile", "96 spheres, capsules and boxes drop into a pit", 200,
                             small_world, build_pile};

}  // namespace lockstone::scenes
