// Boxes in pyramids that stand. Sizes and places are those of Box3D's benchmarks of the same names
// (Erin Catto, shared/benchmarks.c), so that both can be put beside each other. They do not sleep.
#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr int k_half_mm = 500;  // of a box

void add_pyramid(World& world, int rows, int left_mm, int z_mm) {
  BodyDef box = scenes::loose(Shape::box(0.5_m, 0.5_m, 0.5_m), {});
  box.material.density = 100_kgpm3;
  for (int row = 0; row < rows; ++row) {
    for (int i = row; i < rows; ++i) {
      const int x = left_mm + (row + 1) * k_half_mm + 2 * (i - row) * k_half_mm;
      const int y = (2 * row + 1) * k_half_mm;
      box.position = {millimetres(x), millimetres(y), millimetres(z_mm)};
      scenes::add(world, box);
    }
  }
}

World make_large_pyramid(BroadPhaseKind broad_phase) {
  constexpr int k_rows = 100;
  WorldDef def = speed_def(broad_phase, 8192, 65536, 32768);
  def.sleep_ms = 0;
  World world = make_speed_world(def);
  scenes::add_ground(world, 400_m);
  add_pyramid(world, k_rows, -k_rows * k_half_mm, 0);
  return world;
}

World make_many_pyramids(BroadPhaseKind broad_phase) {
  constexpr int k_rows = 10, k_side = 14;
  constexpr int k_ground_mm = k_half_mm * k_side * (k_rows + 1);
  constexpr int k_reach_mm = k_ground_mm - 2 * k_half_mm;
  WorldDef def = speed_def(broad_phase, 16384, 131072, 65536);
  def.sleep_ms = 0;
  World world = make_speed_world(def);
  scenes::add_ground(world, arena::millimetres_long(k_ground_mm));
  for (int i = 0; i < k_side; ++i) {
    for (int j = 0; j < k_side; ++j) {
      const int left_mm = -k_reach_mm + j * 2 * k_half_mm * (k_rows + 1) - k_half_mm;
      add_pyramid(world, k_rows, left_mm, -k_reach_mm + 2 * k_reach_mm * i / (k_side - 1));
    }
  }
  return world;
}

}  // namespace

constinit const SpeedScene k_large_pyramid{"large-pyramid", "one pyramid of 100 rows, 5,050 boxes",
                                           200, make_large_pyramid};
constinit const SpeedScene k_many_pyramids{
    "many-pyramids", "14 x 14 pyramids of 10 rows, 10,780 boxes", 100, make_many_pyramids};

}  // namespace lockstone::bench
