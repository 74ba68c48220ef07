// Scenes about how single bodies move.
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// A table, a ramp that begins at its edge, the floor.
void build_rolling(World& world, std::uint64_t) {
  add_ground(world, 20_m);
  add(world, fixed_box({-6_m, 1_m, {}}, {4_m, 1_m, 2_m}));
  BodyDef ramp = fixed_box({1.81_m, 0.755_m, {}}, {4_m, 0.25_m, 2_m});
  ramp.orientation = from_axis_angle(k_z_axis, -0.2527_rad);
  add(world, ramp);
  BodyDef ball = loose(Shape::sphere(0.5_m), {-9_m, 2.5_m, {}});
  ball.velocity = {3_mps, {}, {}};
  ball.angular_velocity = {{}, {}, -6_rps};  // it rolls from the start
  add(world, ball);
}

void build_capsule(World& world, std::uint64_t) {
  add_ground(world, 10_m);
  BodyDef character = loose(Shape::capsule(0.5_m, 0.4_m), {-1.5_m, 0.9_m, {}});
  character.fixed_rotation = true;
  add(world, character);
  BodyDef free = loose(Shape::capsule(0.5_m, 0.4_m), {1.5_m, 0.92_m, {}});
  free.orientation = from_axis_angle(k_z_axis, -0.05_rad);
  add(world, free);
  BodyDef lying = loose(Shape::capsule(0.8_m, 0.3_m), {{}, 2_m, 2_m});
  lying.orientation = from_axis_angle(k_z_axis, 1.3_rad);
  add(world, lying);
}

void build_bounce(World& world, std::uint64_t, const SceneValues& values) {
  const int balls = values[0];
  add_ground(world, 10_m);
  for (int i = 0; i < balls; ++i) {
    BodyDef ball = loose(Shape::sphere(0.4_m), {millimetres(i * 1200 - 3000), 4_m, {}});
    ball.material.restitution = Coefficient::from_ratio(i, balls - 1);
    add(world, ball);
  }
  BodyDef box = loose(Shape::box(0.4_m, 0.4_m, 0.4_m), {{}, 4_m, 5_m});
  box.orientation = from_axis_angle(k_x_axis, 0.4_rad);
  box.material.restitution = 0.5_r;
  add(world, box);
}

// Each slope is steeper than the one before; on each, three boxes from slippery to rough.
void build_friction(World& world, std::uint64_t) {
  constexpr int k_slopes = 3;
  add_ground(world, 16_m);
  for (int slope = 0; slope < k_slopes; ++slope) {
    const Angle angle = Angle::from_ratio(slope + 1, 5);
    const Quat tilt = from_axis_angle(k_x_axis, angle);
    const Mat3 axes = to_matrix(tilt);
    BodyDef ramp = fixed_box({millimetres((slope - 1) * 5000), 2_m, {}}, {2_m, 0.25_m, 5_m});
    ramp.orientation = tilt;
    ramp.material.friction = 0.5_r;
    add(world, ramp);
    for (int i = 0; i < 3; ++i) {
      const Vec3<Length> on_ramp{millimetres_long((i - 1) * 1300), 0.55_m, -3.5_m};
      BodyDef box = loose(Shape::box(0.4_m, 0.3_m, 0.4_m),
                          ramp.position + rounded<Position>(rotate(axes, on_ramp)));
      box.orientation = tilt;
      box.material.friction = Coefficient::from_ratio(1 + 4 * i, 10);
      add(world, box);
    }
  }
}

WorldDef weightless() {
  WorldDef def = small_world();
  def.gravity = {};
  return def;
}

// Rotation about the middle axis of inertia flips over again and again.
void build_spin(World& world, std::uint64_t) {
  BodyDef box = loose(Shape::box(0.6_m, 0.2_m, 0.4_m), {});
  box.angular_velocity = {0.01_rps, 0.01_rps, 10_rps};
  add(world, box);
  BodyDef slab = loose(Shape::box(0.25_m, 0.75_m, 0.5_m), {2.5_m, {}, {}});
  slab.angular_velocity = {0.01_rps, 0.01_rps, 8_rps};
  add(world, slab);
}

}  // namespace

constinit const Scene k_rolling{"rolling", "a ball rolls over a table and down a ramp", 240,
                                small_world, build_rolling};
constinit const Scene k_capsule{"capsule", "a character stands, two free capsules fall over", 200,
                                small_world, build_capsule};
constinit const Scene k_bounce{.name = "bounce",
                               .description = "balls of restitution 0 to 1 and a box bounce",
                               .golden_ticks = 300,
                               .define = small_world,
                               .builder = build_bounce,
                               .own_parameters = {{{"balls", 6, 2, 11}}}};
constinit const Scene k_friction{"friction", "boxes of three roughnesses on slopes of 11° to 34°",
                                 240, small_world, build_friction};
constinit const Scene k_spin{"spin", "two weightless boxes tumble about the middle axis", 300,
                             weightless, build_spin};

}  // namespace lockstone::scenes
