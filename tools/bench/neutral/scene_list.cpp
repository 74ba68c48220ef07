// The scenes: sizes, masses and times of the rows of accuracy of the same content.
#include <cmath>
#include <numbers>
#include <string>

#include "tools/bench/neutral/scene.h"

namespace lockstone::bench {
namespace {

NeutralScene scene_of(std::string name, std::string description, double seconds) {
  NeutralScene scene;
  scene.name = std::move(name);
  scene.description = std::move(description);
  scene.seconds = seconds;
  return scene;
}

NeutralScene weightless(std::string name, std::string description, double seconds) {
  NeutralScene scene = scene_of(std::move(name), std::move(description), seconds);
  scene.gravity = 0;
  return scene;
}

int add(NeutralScene& scene, const NeutralBody& body, bool watched = true) {
  const int index = static_cast<int>(scene.bodies.size());
  scene.bodies.push_back(body);
  if (watched) scene.watched.push_back(index);
  return index;
}

void record_ends(NeutralScene& scene) {
  scene.record_every = scene.ticks();
}

// Spins without torque.
NeutralScene spinner(std::string name, std::string description, double seconds, Triple half_extents,
                     Triple angular_velocity) {
  NeutralScene scene = weightless(std::move(name), std::move(description), seconds);
  NeutralBody body = neutral_box(half_extents, {});
  body.angular_velocity = angular_velocity;
  add(scene, body);
  return scene;
}

// Links of 1 kg, balls of a quarter of their length, the last of another mass, level with the
// pivot.
NeutralScene chain(std::string name, std::string description, double seconds, int links,
                   double length, double end_mass) {
  NeutralScene scene = scene_of(std::move(name), std::move(description), seconds);
  const double radius = length / 4;
  const double density = 1 / (4 * std::numbers::pi / 3 * radius * radius * radius);
  int last = add(scene, neutral_pivot());
  for (int i = 0; i < links; ++i) {
    NeutralBody link = neutral_ball(radius, {(i + 0.5) * length, 0, 0}, density);
    if (i + 1 == links) link.density *= end_mass;
    link.collides = false;
    const int body = add(scene, link);
    scene.joints.push_back({last, body, {i > 0 ? length / 2 : 0, 0, 0}, {-length / 2, 0, 0}});
    last = body;
  }
  return scene;
}

NeutralScene hung(std::string name, std::string description, double seconds,
                  const NeutralBody& bob) {
  NeutralScene scene = scene_of(std::move(name), std::move(description), seconds);
  add(scene, neutral_pivot(), false);
  add(scene, bob);
  scene.joints.push_back({0, 1, {}, {-bob.position[0], 0, 0}});
  return scene;
}

NeutralScene on_ground(std::string name, std::string description, double seconds) {
  NeutralScene scene = scene_of(std::move(name), std::move(description), seconds);
  add(scene, neutral_ground(), false);
  return scene;
}

NeutralScene stack(int count) {
  const std::string boxes = std::to_string(count) + " boxes";
  NeutralScene scene = on_ground("stack-" + std::to_string(count), "stack of " + boxes, 60);
  for (int i = 0; i < count; ++i)
    add(scene, neutral_box({0.5, 0.5, 0.5}, {0, 0.5 + i, 0}), i + 1 == count);
  record_ends(scene);
  return scene;
}

NeutralScene heavy_on_light(int ratio) {
  const std::string name = std::to_string(ratio);
  NeutralScene scene = on_ground("heavy-" + name, "box " + name + " : 1 on a light one", 10);
  add(scene, neutral_box({0.5, 0.5, 0.5}, {0, 0.5, 0}, 100), false);
  add(scene, neutral_box({0.5, 0.5, 0.5}, {0, 1.5, 0}, 100.0 * ratio));
  return scene;
}

NeutralScene bounce(std::string name, std::string description, double seconds, double restitution) {
  NeutralScene scene = on_ground(std::move(name), std::move(description), seconds);
  scene.restitution = restitution;
  add(scene, neutral_ball(0.25, {0, 1.25, 0}));
  return scene;
}

NeutralScene sliding_headings() {
  constexpr int k_headings = 24;
  NeutralScene scene = on_ground("slide-headings", "boxes slide off in 24 directions", 3);
  for (int i = 0; i < k_headings; ++i) {
    const double heading = 2 * std::numbers::pi * i / k_headings;
    const double x = std::cos(heading), z = std::sin(heading);
    const int box = add(scene, neutral_box({0.5, 0.5, 0.5}, {40 * x, 0.5, 40 * z}));
    scene.kicks.push_back({1, box, {5 * x, 0, 5 * z}});
  }
  return scene;
}

}  // namespace

void add_flight_scenes(std::vector<NeutralScene>& scenes) {
  scenes.push_back(scene_of("free-fall", "free fall, 10 s", 10));
  add(scenes.back(), neutral_ball(0.5, {}));
  record_ends(scenes.back());
  scenes.push_back(weightless("far-drift", "drift of 1 m/s, 100 km away", 10));
  NeutralBody drifter = neutral_ball(0.5, {1e5, 1e5, -1e5});
  drifter.velocity = {1, 0, 0};
  add(scenes.back(), drifter);
  record_ends(scenes.back());
  scenes.push_back(
      spinner("tumble", "torque-free box 1 x 2 x 3 m", 60, {0.5, 1, 1.5}, {0.01, 5, 0}));
  scenes.push_back(spinner("dzhanibekov", "Dzhanibekov's body, I = (1, 2, 3)", 2,
                           {1.41421356, 1, 0.001}, {0.01, 10, 0.01}));
  scenes.push_back(spinner("rod", "rod, I = (.1, 2, 2.05)", 10,
                           {1.40534694, 0.27386128, 0.15811388}, {8, 1, 0.5}));
}

void add_contact_scenes(std::vector<NeutralScene>& scenes) {
  scenes.push_back(on_ground("slide", "box stops from 5 m/s", 3));
  add(scenes.back(), neutral_box({0.5, 0.5, 0.5}, {0, 0.5, 0}));
  scenes.back().kicks.push_back({1, 1, {5, 0, 0}});
  scenes.push_back(sliding_headings());
  scenes.push_back(on_ground("slip", "box on a slope that turns from 26 to 27.2 degrees", 61));
  scenes.back().tilt = {{0, 26}, {1, 26}, {61, 27.2}};
  add(scenes.back(), neutral_box({0.5, 0.5, 0.5}, {0, 0.5, 0}));
  scenes.push_back(on_ground("creep", "box on 20 degrees", 61));
  scenes.back().tilt = {{0, 20}};
  scenes.back().record_every = 60;
  add(scenes.back(), neutral_box({0.5, 0.5, 0.5}, {0, 0.5, 0}));
  scenes.push_back(on_ground("roll", "sphere rolls down 20 degrees", 3));
  scenes.back().tilt = {{0, 20}};
  scenes.back().record_every = 60;
  add(scenes.back(), neutral_ball(0.5, {0, 0.5, 0}));
  scenes.push_back(on_ground("throw", "thrown sphere slips, then rolls", 2));
  scenes.back().friction = 0.3;
  add(scenes.back(), neutral_ball(0.5, {0, 0.5, 0}));
  scenes.back().bodies.back().velocity = {7, 0, 0};
  scenes.push_back(bounce("bounce", "sphere drops 1 m, e = 0.8", 0.6, 0.8));
  scenes.push_back(bounce("bounces", "sphere drops 1 m, e = 1, 20 times", 18.2, 1));
  scenes.push_back(weightless("cradle", "Newton's cradle, 5 spheres", 2));
  scenes.back().restitution = 1;
  scenes.back().friction = 0;
  for (int i = 0; i < 5; ++i)
    add(scenes.back(), neutral_ball(0.25, {0.5 * i, 0, 0}));
  scenes.back().bodies.front().velocity = {1, 0, 0};
  for (const int count : {20, 40})
    scenes.push_back(stack(count));
  for (const int ratio : {10, 100, 1000})
    scenes.push_back(heavy_on_light(ratio));
}

void add_joint_scenes(std::vector<NeutralScene>& scenes) {
  scenes.push_back(
      hung("pendulum", "pendulum from 90 degrees, 60 s", 60, neutral_ball(0.1, {1, 0, 0})));
  scenes.push_back(hung("rod-pendulum", "rod pendulum from 90 degrees, 60 s", 60,
                        neutral_box({0.5, 0.02, 0.02}, {0.5, 0, 0})));
  scenes.push_back(
      hung("double-pendulum", "double pendulum, 5 s", 5, neutral_ball(0.1, {1, 0, 0})));
  NeutralScene& two = scenes.back();
  add(two, neutral_ball(0.1, {2, 0, 0}));
  two.joints.push_back({1, 2, {}, {-1, 0, 0}});
  constexpr double k_spin = 60, k_arm = 0.3, k_axial = 0.06,
                   k_rate = 9.81 * k_arm / (k_axial * k_spin);
  NeutralBody disc = neutral_box({0.05, 0.3, 0.3}, {k_arm, 0, 0});
  disc.angular_velocity = {k_spin, k_rate, 0};
  disc.velocity = {0, 0, -k_rate * k_arm};
  scenes.push_back(hung("top", "heavy top on a ball joint, 10 s", 10, disc));
  scenes.push_back(chain("chain", "chain of 10, 100 : 1 at its end", 20, 10, 1, 100));
  scenes.push_back(chain("heavy-chain", "chain of 20, 1000 : 1 at its end", 10, 20, 0.25, 1000));
}

void add_large_scenes(std::vector<NeutralScene>& scenes) {
  constexpr int k_rows = 20, k_side = 20;
  scenes.push_back(on_ground("pyramid", "pyramid of 210 boxes", 5));
  for (int row = 0; row < k_rows; ++row) {
    for (int i = row; i < k_rows; ++i)
      add(scenes.back(), neutral_box({0.5, 0.5, 0.5}, {i - row / 2.0, row + 0.5, 0}, 100),
          row + 1 == k_rows);
  }
  record_ends(scenes.back());
  scenes.push_back(scene_of("net", "net of 20 x 20 balls on 741 joints", 5));
  NeutralScene& net = scenes.back();
  for (int i = 0; i < k_side * k_side; ++i) {
    const int column = i % k_side, row = i / k_side;
    NeutralBody ball = neutral_ball(0.4, {1.0 * column, -1.0 * row, 0});
    ball.collides = false;
    ball.fixed = row == 0;
    add(net, ball);
    if (row == 0) continue;
    if (column > 0) net.joints.push_back({i - 1, i, {0.5, 0, 0}, {-0.5, 0, 0}});
    net.joints.push_back({i - k_side, i, {0, -0.5, 0}, {0, 0.5, 0}});
  }
  record_ends(net);
}

}  // namespace lockstone::bench
