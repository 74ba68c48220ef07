// Houses of loose blocks, all asleep.
#include "tools/bench/speed/city.h"

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr int k_floors = 5;
constexpr int k_row = 50;  // houses
constexpr int k_spacing_mm = 3000;

}  // namespace

World make_city(BroadPhaseKind broad_phase, std::uint32_t bodies) {
  World world = make_speed_world(speed_def(broad_phase, bodies + 8, 4 * bodies, 2 * bodies));
  scenes::add_ground(world, 250_m);
  for (std::uint32_t i = 0; i < bodies; ++i) {
    const int house = static_cast<int>(i) / k_floors, floor = static_cast<int>(i) % k_floors;
    const int x = (house % k_row - k_row / 2) * k_spacing_mm;
    const int z = (house / k_row - k_row / 2) * k_spacing_mm;
    scenes::add(world,
                scenes::loose(Shape::box(0.5_m, 0.5_m, 0.5_m),
                              {millimetres(x), millimetres(500 + 1000 * floor), millimetres(z)}));
  }
  step_until_asleep(world, bodies);
  return world;
}

namespace {

World make_whole_city(BroadPhaseKind broad_phase) {
  return make_city(broad_phase, 10'000);
}

}  // namespace

constinit const SpeedScene k_city{"city", "2,000 houses of 5 blocks, all asleep", 1000,
                                  make_whole_city};

}  // namespace lockstone::bench
