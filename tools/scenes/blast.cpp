// An explosion behind a wall, and one in the open.
#include <array>
#include <span>

#include <lockstone/radial_impulse.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint32_t k_shield = 2;  // the category of walls

void build_explosion(World& world, std::uint64_t) {
  add_ground(world, 14_m);
  BodyDef wall = fixed_box({2_m, 1_m, {}}, {0.2_m, 1_m, 3_m});
  wall.filter.category = k_shield;
  add(world, wall);
  // Crates before the wall and behind it, two high; a pile farther off.
  for (const std::int32_t x : {-2500, 4000}) {
    for (int i = 0; i < 5; ++i) {
      for (int level = 0; level < 2; ++level) {
        add(world,
            loose(Shape::box(0.4_m, 0.4_m, 0.4_m),
                  {millimetres(x), millimetres(400 + level * 800), millimetres(i * 1000 - 2000)}));
      }
    }
  }
  for (int i = 0; i < 6; ++i)
    add(world, loose(Shape::sphere(0.3_m), {millimetres(i * 900 - 2300), 0.3_m, -5_m}));
}

void drive_explosion(World& world, std::uint64_t) {
  if (world.tick() != 30 && world.tick() != 150) return;
  RadialImpulse blast{.radius = 7_m, .impulse = 3000_Ns};
  blast.centre =
      world.tick() == 30 ? Vec3<Position>{{}, 0.5_m, {}} : Vec3<Position>{6_m, 0.2_m, {}};
  blast.obstacle_mask = k_shield;
  std::array<ApplyImpulse, 64> pushes;
  const std::size_t count = radial_impulse(world, blast, pushes);
  for (const ApplyImpulse& push : std::span(pushes).first(count))
    order(world, push);
}

}  // namespace

constinit const Scene k_explosion{
    "explosion",    "explosions that a wall shields crates from", 240, small_world, build_explosion,
    drive_explosion};

}  // namespace lockstone::scenes
