// Bodies that fall into a walled pit and come to rest there.
#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using arena::Random;
using scenes::millimetres;

constexpr int k_columns = 20;  // each way
constexpr int k_spacing_mm = 1200;
constexpr int k_pit_mm = k_columns * k_spacing_mm / 2;  // half its width

Length half_pit(int more_mm) {
  return arena::millimetres_long(k_pit_mm + more_mm);
}

World make_pit(BroadPhaseKind broad_phase) {
  World world = make_speed_world(speed_def(broad_phase, 8192, 131072, 65536));
  scenes::add_ground(world, half_pit(1000));
  for (const int side : {-1, 1}) {
    const Position place = millimetres(side * (k_pit_mm + 500));
    scenes::add(world, scenes::fixed_box({place, 10_m, {}}, {0.5_m, 10_m, half_pit(1000)}));
    scenes::add(world, scenes::fixed_box({{}, 10_m, place}, {half_pit(0), 10_m, 0.5_m}));
  }
  return world;
}

std::int32_t column_mm(int column) {
  return (2 * column + 1 - k_columns) * k_spacing_mm / 2;
}

// Layer upon layer of loose bodies, a little out of line so that none balance.
void add_rain(World& world, int layers, Shape (*shape)(Random&)) {
  Random random(1);
  for (int i = 0; i < layers * k_columns * k_columns; ++i) {
    const std::int32_t x = column_mm(i % k_columns) + random.between(-150, 150);
    const std::int32_t z = column_mm(i / k_columns % k_columns) + random.between(-150, 150);
    const int layer = i / (k_columns * k_columns);
    BodyDef body = scenes::loose(
        shape(random), {millimetres(x), millimetres(3000 + layer * 1300), millimetres(z)});
    body.orientation = scenes::random_orientation(random);
    scenes::add(world, body);
  }
}

Length between_mm(Random& random, int low, int high) {
  return arena::millimetres_long(random.between(low, high));
}

Shape random_ball(Random& random) {
  return Shape::sphere(between_mm(random, 200, 450));
}

Shape random_capsule(Random& random) {
  const Length half_height = between_mm(random, 150, 300);
  return Shape::capsule(half_height, between_mm(random, 100, 250));
}

Shape random_box(Random& random) {
  const Length x = between_mm(random, 150, 350), y = between_mm(random, 150, 350);
  return Shape::box(x, y, between_mm(random, 150, 350));
}

World make_ball_rain(BroadPhaseKind broad_phase) {
  World world = make_pit(broad_phase);
  add_rain(world, 12, random_ball);
  return world;
}

World make_capsule_pile(BroadPhaseKind broad_phase) {
  World world = make_pit(broad_phase);
  add_rain(world, 8, random_capsule);
  return world;
}

World make_box_rain(BroadPhaseKind broad_phase) {
  World world = make_pit(broad_phase);
  for (int i = 0; i < k_columns * k_columns; ++i) {
    const Vec3<Position> place{
        millimetres(column_mm(i % k_columns)), {}, millimetres(column_mm(i / k_columns))};
    BodyDef block = scenes::fixed_box(place, {0.4_m, 0.4_m, 0.4_m});
    block.orientation = from_axis_angle(scenes::k_y_axis, 0.4_rad);
    scenes::add(world, block);
  }
  add_rain(world, 8, random_box);
  return world;
}

World make_mixed(BroadPhaseKind broad_phase) {
  World world = make_pit(broad_phase);
  add_rain(world, 8, scenes::random_shape);
  return world;
}

}  // namespace

constinit const SpeedScene k_ball_rain{"ball-rain", "4,800 balls fall into a pit", 300,
                                       make_ball_rain};
constinit const SpeedScene k_capsule_pile{"capsule-pile", "3,200 capsules fall into a pit", 300,
                                          make_capsule_pile};
constinit const SpeedScene k_box_rain{"box-rain", "3,200 boxes fall on 400 fixed ones", 300,
                                      make_box_rain};
constinit const SpeedScene k_mixed{"mixed-pile", "3,200 balls, capsules and boxes fall into a pit",
                                   300, make_mixed};

}  // namespace lockstone::bench
