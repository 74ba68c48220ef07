// Surfaces that move, and surfaces that resist rolling.
#include <algorithm>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// A belt that climbs, and one across that carries on the bodies that fall from it.
void add_belts(World& world) {
  BodyDef belt = fixed_box({-3_m, 1.5_m, -3_m}, {3_m, 0.2_m, 1_m});
  belt.orientation = from_axis_angle(k_z_axis, 0.3_rad);
  belt.surface_motion.velocity = {2_mps, {}, {}};
  belt.material.friction = 0.9_r;
  add(world, belt);
  BodyDef across = fixed_box({1.5_m, 1_m, {}}, {1_m, 0.2_m, 4_m});
  across.surface_motion.velocity = {{}, {}, 1.5_mps};
  add(world, across);
  const Mat3 axes = to_matrix(belt.orientation);
  for (int i = 0; i < 4; ++i) {
    const Vec3<Length> on_belt{millimetres_long(i * 800 - 2500), 0.455_m, {}};
    BodyDef box = loose(Shape::box(0.25_m, 0.25_m, 0.25_m),
                        belt.position + rounded<Position>(rotate(axes, on_belt)));
    box.orientation = belt.orientation;
    box.material.friction = 0.9_r;
    add(world, box);
  }
}

// Bodies farther out slip off.
void add_turntable(World& world) {
  BodyDef table = fixed_box({-4_m, 0.5_m, 3_m}, {2_m, 0.2_m, 2_m});
  table.surface_motion.turning = {{}, 2_rps, {}};
  add(world, table);
  for (int i = 0; i < 5; ++i) {
    const Shape shape = i % 2 == 0 ? Shape::box(0.15_m, 0.15_m, 0.15_m) : Shape::sphere(0.15_m);
    add(world, loose(shape, {millimetres(-4000 + i * 400), 0.855_m, 3_m}));
  }
}

// Balls on a slope of 0.15 rad: the more a ball resists rolling the slower it is; the last stays.
void add_slope(World& world) {
  BodyDef slope = fixed_box({6_m, 1_m, {}}, {2_m, 0.2_m, 4_m});
  slope.orientation = from_axis_angle(k_x_axis, 0.15_rad);
  add(world, slope);
  const Mat3 axes = to_matrix(slope.orientation);
  for (int i = 0; i < 5; ++i) {
    const Vec3<Length> on_slope{millimetres_long(i * 800 - 1600), 0.5_m, -3_m};
    BodyDef ball =
        loose(Shape::sphere(0.3_m), slope.position + rounded<Position>(rotate(axes, on_slope)));
    ball.material.rolling_resistance = Coefficient::from_ratio(i, 20);
    add(world, ball);
  }
}

// A box is pushed by a force that grows until it moves; another keeps a lane by locked axes.
void push(World& world, std::uint64_t) {
  const auto tick = static_cast<std::int64_t>(std::min<std::uint64_t>(world.tick(), 240));
  const Force strength = Force::from_integer(tick * 2);
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyView body = world.body(world.body_at(i));
    if (body.user_data == 1) order(world, ApplyForce{world.body_at(i), {{}, {}, strength}});
  }
}

void build_belts(World& world, std::uint64_t) {
  add_ground(world, 10_m);
  add_belts(world);
  add_turntable(world);
  add_slope(world);
  BodyDef pushed = loose(Shape::box(0.4_m, 0.2_m, 0.4_m), {8.5_m, 0.2_m, -6_m});
  pushed.user_data = 1;
  pushed.material.density = 200_kgpm3;
  add(world, pushed);
  BodyDef kept = pushed;
  kept.position = {7_m, 0.2_m, -6_m};
  kept.orientation = from_axis_angle(k_y_axis, 0.4_rad);
  kept.locks.move_x = kept.locks.turn_y = true;
  add(world, kept);
}

}  // namespace

constinit const Scene k_belts{.name = "belts",
                              .description = "belts, a turntable, balls that resist rolling",
                              .golden_ticks = 300,
                              .define = small_world,
                              .builder = build_belts,
                              .drive = push};

}  // namespace lockstone::scenes
