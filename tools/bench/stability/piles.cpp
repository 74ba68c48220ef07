// Stacks, pyramids, unequal masses and sizes, deep overlaps.
#include <array>

#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "tools/bench/stability/stability_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

double height_of(const World& world, BodyHandle body) {
  return testing::to_double(world.position(body).y);
}

double aside(const World& world, BodyHandle body, double x = 0, double z = 0) {
  const Vec3<Position> at = world.position(body);
  return std::hypot(testing::to_double(at.x) - x, testing::to_double(at.z) - z);
}

// Unit boxes; the top one tells.
StabilityResult stack(int boxes, double seconds, bool sleeps) {
  WorldDef def = contact_world(128);
  if (sleeps) def.sleep_ms = WorldDef{}.sleep_ms;
  SceneRun scene(k_usual_setting, def);
  scene.add(ground());
  BodyHandle top;
  for (int i = 0; i < boxes; ++i)
    top = scene.add(body_at(unit_box(), 0, 0.5 + i, 0));
  scene.run(seconds);
  const World& world = scene.world();
  return stability_of(scene, {{"top box aside", "m", aside(world, top), 0.01},
                              {"height lost", "m", boxes - 0.5 - height_of(world, top), 0.05}});
}

StabilityResult stack_10(double seconds) {
  return stack(10, seconds, false);
}
StabilityResult stack_50(double seconds) {
  return stack(50, seconds, false);
}
StabilityResult stack_100(double seconds) {
  return stack(100, seconds, false);
}
StabilityResult stack_10_asleep(double seconds) {
  return stack(10, seconds, true);
}
StabilityResult stack_50_asleep(double seconds) {
  return stack(50, seconds, true);
}
StabilityResult stack_100_asleep(double seconds) {
  return stack(100, seconds, true);
}

StabilityResult pyramid(double seconds) {
  constexpr int k_rows = 100;
  WorldDef def = contact_world(8192);
  def.sleep_ms = 0;
  SceneRun scene(k_usual_setting, def);
  scene.add(ground());
  BodyHandle top;
  for (int row = 0; row < k_rows; ++row) {
    for (int i = 0; i < k_rows - row; ++i)
      top = scene.add(body_at(unit_box(), 1.1 * i + 0.55 * row - 55, 0.5 + row, 0));
  }
  const double x = testing::to_double(scene.world().position(top).x);
  scene.run(seconds);
  const World& world = scene.world();
  return stability_of(scene, {{"top box aside", "m", aside(world, top, x), 0.05},
                              {"height lost", "m", k_rows - 0.5 - height_of(world, top), 0.1}});
}

// A heavy box on a light one.
StabilityResult mass_ratio(double seconds) {
  WorldDef def = contact_world();
  def.sleep_ms = 0;
  SceneRun scene(k_usual_setting, def);
  scene.add(ground());
  BodyDef light = body_at(unit_box(), 0, 0.5, 0), heavy = body_at(unit_box(), 0, 1.5, 0);
  light.material.density = 10_kgpm3;
  heavy.material.density = 1'000'000_kgpm3;
  scene.add(light);
  const BodyHandle top = scene.add(heavy);
  scene.run(seconds);
  return stability_of(scene, {{"heavy box sunk", "m", 1.5 - height_of(scene.world(), top), 0.01},
                              {"aside", "m", aside(scene.world(), top), 0.01}});
}

// Balls of 1 cm and a plate of 200 m, on and under each other.
StabilityResult sizes(double seconds) {
  WorldDef def = contact_world();
  SceneRun scene(k_usual_setting, def);
  scene.add(ground());
  std::vector<BodyHandle> balls;
  for (int i = 0; i < 16; ++i)
    balls.push_back(scene.add(body_at(Shape::sphere(0.01_m), 2.0 * i - 15, 0.05, 0)));
  BodyDef giant = body_at(Shape::sphere(100_m), 0, 100, 150);
  giant.position.z = Position::from_integer(60);
  giant.material.density = 100_kgpm3;  // or it would weigh more than anything may
  const BodyHandle large = scene.add(giant);
  const auto [speed] = worst_of(scene, seconds, greatest_speed);
  double off = 0;
  for (const BodyHandle ball : balls)
    off = std::max(off, std::abs(height_of(scene.world(), ball) - 0.01));
  return stability_of(scene, {{"small ball off the floor", "m", off, 1e-4},
                              {"large ball off the floor", "m",
                               std::abs(height_of(scene.world(), large) - 100), 0.02},
                              {"greatest speed", "m/s", speed, 3}});
}

// The deepest overlap of two spheres of half a metre, m.
double deepest_overlap(const World& world) {
  std::vector<Vec3<Position>> centres;
  for_bodies(world, [&](const BodyView& body) { centres.push_back(body.position); });
  double deepest = 0;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    for (std::size_t k = i + 1; k < centres.size(); ++k)
      deepest = std::max(deepest, 1 - fuzz::norm(fuzz::real(centres[i] - centres[k])));
  }
  return deepest;
}

StabilityResult overlap(double seconds) {
  WorldDef def = contact_world(256);
  def.gravity = {};
  def.pair_capacity = def.contact_capacity = 200 * 200 / 2;
  SceneRun scene(k_usual_setting, def);
  for (int i = 0; i < 200; ++i) {
    const double turn = 2.399963 * i;  // by the golden angle, so that no two are in one place
    scene.add(body_at(Shape::sphere(0.5_m), 1e-3 * i * std::cos(turn), 1e-3 * (i % 7),
                      1e-3 * i * std::sin(turn)));
  }
  const auto [speed] = worst_of(scene, seconds, greatest_speed);
  return stability_of(scene, {{"greatest speed", "m/s", speed, 30},
                              {"deepest overlap left", "m", deepest_overlap(scene.world()), 0.01}});
}

// Balls, boxes and capsules in a pit, stirred for ever.
StabilityResult mixed(double seconds) {
  SceneRun scene(k_usual_setting, contact_world(128));
  fill_stirred_pit(scene);
  const auto [speed, norm] = worst_of(scene, seconds, greatest_speed, worst_norm);
  return stability_of(scene,
                      {{"greatest speed", "m/s", speed, 15},
                       {"quaternion's length off 1", "", norm, 1e-8},
                       {"deepest centre below the floor", "m", greatest_depth(scene.world()), 0}});
}

}  // namespace

void fill_stirred_pit(SceneRun& scene) {
  scene.add(ground());
  for (int side = 0; side < 4; ++side) {
    BodyDef wall = ground();
    wall.shape = side < 2 ? Shape::box(1_m, 20_m, 8_m) : Shape::box(8_m, 20_m, 1_m);
    const double away = side % 2 == 0 ? 6 : -6;
    wall.position = side < 2 ? fixed<Position>(away, 10, 0) : fixed<Position>(0, 10, away);
    scene.add(wall);
  }
  BodyDef paddle;
  paddle.motion = MotionType::kinematic;
  paddle.shape = Shape::box(4_m, 0.3_m, 0.2_m);
  paddle.position.y = 0.8_m;
  paddle.angular_velocity.y = 1_rps;
  scene.add(paddle);
  for (int i = 0; i < 60; ++i) {
    const double x = i % 4 * 1.5 - 2.25, z = i / 4 % 4 * 1.5 - 2.25;
    const Shape shape = i % 3 == 0   ? Shape::sphere(0.4_m)
                        : i % 3 == 1 ? Shape::capsule(0.25_m, 0.3_m)
                                     : Shape::box(0.4_m, 0.3_m, 0.35_m);
    scene.add(body_at(shape, x, 2 + i / 16 * 1.2, z));
  }
}

namespace {

constexpr StabilityRow k_rows[] = {
    {"stack-10", "ten boxes, which never sleep", 600, stack_10},
    {"stack-50", "fifty boxes, which never sleep", 600, stack_50},
    {"stack-100", "a hundred boxes, which never sleep", 600, stack_100},
    {"stack-10-asleep", "ten boxes, which may sleep", 600, stack_10_asleep},
    {"stack-50-asleep", "fifty boxes, which may sleep", 600, stack_50_asleep},
    {"stack-100-asleep", "a hundred boxes, which may sleep", 600, stack_100_asleep},
    {"pyramid-100", "a pyramid of 100 rows", 60, pyramid},
    {"mass-ratio", "a box on another one of 1/100,000 of its mass", 600, mass_ratio},
    {"sizes", "balls of 1 cm and of 100 m on one floor", 600, sizes},
    {"overlap", "200 balls begin in one place", 60, overlap},
    {"mixed", "balls, boxes and capsules in a pit, stirred: a million ticks", 16'667, mixed},
};

}  // namespace

std::span<const StabilityRow> heap_rows() {
  return k_rows;
}

}  // namespace lockstone::bench
