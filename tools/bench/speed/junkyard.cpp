// Rocks in a walled yard, swept by a pillar on a circle. Numbers and sizes are those of Box3D's
// benchmark "junkyard" (Erin Catto, shared/benchmarks.c); the rock's points are our own.
#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/assets.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr Length k_pillar_half_height = 12_m;

// Where the pillar stands at a tick: six degrees a second on a circle of 35 m.
Vec3<Position> pillar_at(std::uint64_t tick) {
  const auto turned = static_cast<std::int64_t>(tick % 3600) * 104'720;  // µrad·60
  const Quat turn = from_axis_angle(scenes::k_y_axis, Angle::from_ratio(turned, 60'000'000));
  return rotate(to_matrix(turn), Vec3<Position>{35_m, {}, {}}) + Vec3<Position>{{}, 12_m, {}};
}

void add_walls(World& world) {
  scenes::add_ground(world, 120_m);
  for (const int side : {-1, 1}) {
    const Position place = millimetres(side * 50'000);
    scenes::add(world, scenes::fixed_box({place, 8_m, {}}, {1_m, 8_m, 50_m}));
    scenes::add(world, scenes::fixed_box({{}, 8_m, place}, {50_m, 8_m, 1_m}));
  }
}

World make_junkyard(BroadPhaseKind broad_phase) {
  constexpr int k_side = 21, k_layers = 24, k_spacing_mm = 4000, k_lowest_mm = 25'000;
  arena::Random random(7);
  const AssetPtr rock = scenes::random_hull(random, {1.5_m, 1.5_m, 1.5_m}, 24);
  const AssetPtr pillar = scenes::prism(16, 4_m, k_pillar_half_height);
  World world = make_speed_world(speed_def(broad_phase, 16'384, 262'144, 131'072), {rock, pillar});
  add_walls(world);
  BodyDef pusher = scenes::fixed(pillar->shape(), pillar_at(0));
  pusher.motion = MotionType::kinematic;
  pusher.user_data = 1;
  scenes::add(world, pusher);
  for (int i = 0; i < k_layers * k_side * k_side; ++i) {
    const auto place = [](int n) { return millimetres((n - k_side / 2) * k_spacing_mm); };
    const int layer = i / (k_side * k_side);
    scenes::add(
        world, scenes::loose(rock->shape(),
                             {place(i / k_side % k_side),
                              millimetres(k_lowest_mm + layer * k_spacing_mm), place(i % k_side)}));
  }
  return world;
}

// The pusher is the first body that has user data.
BodyHandle pusher_of(const World& world) {
  std::uint32_t index = 0;
  while (world.body(world.body_at(index)).user_data == 0)
    ++index;
  return world.body_at(index);
}

void sweep(World& world) {
  scenes::order(world, MoveKinematic{pusher_of(world), pillar_at(world.tick() + 1), Quat{}});
}

}  // namespace

constinit const SpeedScene k_junkyard{"junkyard", "10,584 rocks swept by a pusher", 800,
                                      make_junkyard, sweep};

}  // namespace lockstone::bench
