// Cubes in a turning drum. Sizes and speeds are those of Box3D's benchmark "washer" (Erin Catto,
// shared/benchmarks.c); the drum's forty pieces are boxes here, wedges there.
#include <vector>

#include <lockstone/compound.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr int k_walls = 36;
constexpr int k_walls_per_paddle = 9;

// A piece whose middle is `radius` from the axis, turned about it by an angle.
CompoundChild piece_at(Angle angle, Position radius, const Shape& shape) {
  CompoundChild child;
  child.shape = shape;
  child.orientation = from_axis_angle(scenes::k_z_axis, angle);
  const Vec3<Position> middle =
      rotate(to_matrix(child.orientation), Vec3<Position>{radius, {}, {}});
  child.position = saturated<Length>(middle);
  return child;
}

AssetPtr make_drum() {
  std::vector<CompoundChild> pieces;
  for (int i = 0; i < k_walls; ++i) {
    const Angle angle = Angle::from_ratio(6'283'185LL * i, 1'000'000LL * k_walls);
    pieces.push_back(piece_at(angle, 17_m, Shape::box(1_m, 1.45_m, 10_m)));
    if (i % k_walls_per_paddle == 0)
      pieces.push_back(piece_at(angle, 15_m, Shape::box(1_m, 1.2_m, 10_m)));
  }
  const CompoundResult drum = Compound::build(pieces);
  LKS_CHECK(drum.ok());
  return drum.compound;
}

void add_drum(World& world, const Shape& drum) {
  BodyDef body = scenes::loose(drum, {{}, 21_m, {}});
  body.motion = MotionType::kinematic;
  body.angular_velocity = {{}, {}, 0.436332_rps};  // 25 degrees a second
  body.velocity = {0.001_mps, -0.002_mps, {}};
  scenes::add(world, body);
}

World make_washer(BroadPhaseKind broad_phase) {
  constexpr int k_side = 20, k_spacing_mm = 800;
  const AssetPtr drum = make_drum();
  World world = make_speed_world(speed_def(broad_phase, 8192, 131072, 65536), {drum});
  scenes::add_ground(world, 60_m);
  add_drum(world, drum->shape());
  for (int i = 0; i < k_side * k_side * k_side; ++i) {
    const auto coordinate = [](int n) { return n * k_spacing_mm - k_side * k_spacing_mm / 2; };
    const int x = coordinate(i / (k_side * k_side));
    const int y = coordinate(i / k_side % k_side);
    const int z = coordinate(i % k_side);
    const Vec3<Position> place{millimetres(x), millimetres(y + 21'000), millimetres(z)};
    scenes::add(world, scenes::loose(Shape::box(0.2_m, 0.2_m, 0.2_m), place));
  }
  return world;
}

}  // namespace

constinit const SpeedScene k_washer{"washer", "8,000 cubes in a turning drum of 40 pieces", 1000,
                                    make_washer};

}  // namespace lockstone::bench
