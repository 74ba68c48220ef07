// Hulls that collapse into a pile. Numbers and sizes are those of Box3D's benchmark "convex pile"
// (Erin Catto, shared/benchmarks.c); the random points are our own.
#include <vector>

#include <lockstone/hull.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr int k_points = 32;
constexpr int k_radius_mm = 2000;

// The hull of random points on a sphere.
AssetPtr make_rock() {
  arena::Random random(42);
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < k_points; ++i) {
    const Mat3 turn = to_matrix(scenes::random_orientation(random));
    const Vec3<Position> point = rotate(turn, Vec3<Position>{millimetres(k_radius_mm), {}, {}});
    points.push_back(saturated<Length>(point));
  }
  const HullResult rock = Hull::build(points);
  LKS_CHECK(rock.ok());
  return rock.hull;
}

World make_convex_pile(BroadPhaseKind broad_phase) {
  constexpr int k_side = 8, k_layers = 80, k_spacing_mm = 2 * k_radius_mm;
  const AssetPtr rock = make_rock();
  World world = make_speed_world(speed_def(broad_phase, 8192, 262144, 65536), {rock});
  scenes::add_ground(world, 250_m);
  for (int i = 0; i < k_layers * k_side * k_side; ++i) {
    const int x = i % k_side - k_side / 2, z = i / k_side % k_side - k_side / 2;
    const int layer = i / (k_side * k_side);
    scenes::add(world,
                scenes::loose(rock->shape(), {millimetres(x * k_spacing_mm),
                                              millimetres(k_radius_mm + layer * k_spacing_mm),
                                              millimetres(z * k_spacing_mm)}));
  }
  return world;
}

}  // namespace

constinit const SpeedScene k_convex_pile{"convex-pile", "5,120 hulls of 32 points", 500,
                                         make_convex_pile};

}  // namespace lockstone::bench
