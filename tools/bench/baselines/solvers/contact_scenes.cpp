#include <cmath>
#include <numbers>

#include "tools/bench/baselines/solvers/scenes.h"

namespace lockstone::bench::trial {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

Quat about_z(double angle) {
  return rotation({0, 0, angle});
}
Quat about_y(double angle) {
  return rotation({0, angle, 0});
}

void stack(System& s, Random& r, int count, const Vec3& at, double half) {
  for (int i = 0; i < count; ++i)
    s.add_box({half, half, half},
              at + Vec3{r(-.03, .03) * 2 * half, half * (2 * i + 1), r(-.03, .03) * 2 * half}, 1000,
              about_y(r(-.1, .1)));
}

void one_stack(Scene& scene, Random& r, double count) {
  scene.system.add_ground();
  stack(scene.system, r, static_cast<int>(count), {}, 0.5);
}

void fourteen_stacks(Scene& scene, Random& r, double count) {
  scene.system.add_ground();
  for (int i = 0; i < 14; ++i)
    stack(scene.system, r, static_cast<int>(count), {2.0 * (i % 7), 0, 2.0 * (i / 7)}, 0.25);
}

void wall(Scene& scene, Random& r, double courses) {
  scene.system.add_ground();
  const auto brick = [&](double x, int row, double half) {
    scene.system.add_box({half, 0.1, 0.125}, {x + r(-.001, .001), 0.1 + 0.2 * row, r(-.001, .001)},
                         1000);
  };
  for (int row = 0; row < courses; ++row) {
    const bool odd = row % 2 == 1;
    for (int i = 0; i < (odd ? 9 : 10); ++i)
      brick(0.25 + (odd ? 0.25 : 0) + 0.502 * i, row, 0.25);
    if (!odd) continue;
    brick(0.123, row, 0.122);
    brick(0.5 * 10 - 0.105, row, 0.122);
  }
}

void round_tower(Scene& scene, Random& r, double rings) {
  scene.system.add_ground();
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < 12; ++i) {
      const double angle = 30 * k_degree * (i + ring % 2 * 0.5);
      scene.system.add_box({0.24, 0.1, 0.1},
                           {std::cos(angle), 0.1 + 0.2 * ring + r(0, 1e-4), std::sin(angle)}, 1000,
                           about_y(-angle + 90 * k_degree));
    }
}

void jenga(Scene& scene, Random& r, double layers) {
  scene.system.add_ground();
  for (int layer = 0; layer < layers; ++layer)
    for (int i = -1; i < 2; ++i) {
      const double off = 0.0252 * i;
      const Vec3 at = layer % 2 ? Vec3{off, 0, 0} : Vec3{0, 0, off};
      const Vec3 half = layer % 2 ? Vec3{0.0125, 0.0075, 0.0375} : Vec3{0.0375, 0.0075, 0.0125};
      scene.system.add_box(half, at + Vec3{r(-1e-4, 1e-4), 0.0075 + 0.015 * layer, r(-1e-4, 1e-4)},
                           600);
    }
  scene.system.margin = 0.002;
}

// A card of 0.25 × 0.01 × 0.175 m half, leaning; its lowest edge is at `y`.
void card(System& s, double x, double y, double lean) {
  s.add_box({0.005, 0.25, 0.175}, {x, y, 0}, 600, about_z(lean));
}

void card_house(Scene& scene, double floors, double degrees) {
  scene.system.add_ground();
  scene.system.margin = 0.002;
  const double lean = degrees * k_degree, l = 0.25, t = 0.005;
  const double hx = l * std::sin(lean) + t * std::cos(lean);
  const double hy = l * std::cos(lean) + t * std::sin(lean);
  const double pitch = 4 * hx + 0.004;
  double y = 0;
  for (int floor = 0; floor < floors; ++floor) {
    const int count = static_cast<int>(floors) - floor;
    for (int i = 0; i < count; ++i) {
      const double x = (i - (count - 1) / 2.0) * pitch;
      card(scene.system, x - hx - 5e-5, y + hy, -lean);
      card(scene.system, x + hx + 5e-5, y + hy, lean);
    }
    y += 2 * hy;
    for (int i = 0; i + 1 < count; ++i)
      scene.system.add_box({pitch / 2 - 0.001, t, 0.175},
                           {(i - (count - 2) / 2.0) * pitch, y + t, 0}, 600);
    y += 2 * t;
  }
}

void cards(Scene& scene, Random& r, double floors) {
  card_house(scene, floors, r(15, 25));
}

void boards(Scene& scene, Random& r, double) {
  card_house(scene, 1, r(10, 25));
  scene.seconds = 30;
}

void legs(System& s) {
  for (const double x : {-0.6, 0.6})
    for (const double z : {-0.6, 0.6})
      s.add_box({0.05, 0.4, 0.05}, {x, 0.4, z}, 1000);
}

void table(Scene& scene, Random& r, double ratio) {
  System& s = scene.system;
  s.add_ground();
  legs(s);
  s.set_mass(s.add_box({1, 0.05, 1}, {r(-.4, .4), 0.85, r(-.3, .3)}, 1), 8 * ratio);
}

void tipping_table(Scene& scene, Random& r, double ratio) {
  System& s = scene.system;
  s.add_ground();
  legs(s);
  s.set_mass(s.add_box({1, 0.05, 1}, {r(.65, .8), 0.85, r(-.3, .3)}, 1), 8 * ratio);
  scene.stands = false;
}

void heavy_on_light(Scene& scene, Random& r, double ratio) {
  System& s = scene.system;
  s.add_ground();
  s.add_box({0.5, 0.5, 0.5}, {0, 0.5, 0}, 1000);
  s.add_box({0.5, 0.5, 0.5}, {r(-.2, .2), 1.5, r(-.2, .2)}, 1000 * ratio);
}

void heavy_drop(Scene& scene, Random& r, double ratio) {
  System& s = scene.system;
  s.add_ground();
  s.add_box({0.5, 0.5, 0.5}, {0, 0.5, 0}, 1000);
  s.add_box({0.5, 0.5, 0.5}, {r(-.3, .3), 2.5, r(-.3, .3)}, 1000 * ratio);
  scene.stands = false;
}

void plate_on_boxes(Scene& scene, Random& r, double side) {
  System& s = scene.system;
  s.add_ground();
  for (int i = 0; i < side * side; ++i)
    s.add_box({0.05, 0.05, 0.05},
              {0.2 * (i % static_cast<int>(side)), 0.05, 0.2 * (i / static_cast<int>(side))}, 1000);
  const double centre = 0.1 * (side - 1);
  s.set_mass(s.add_box({centre + 0.1, 0.05, centre + 0.1},
                       {centre + r(-.02, .02), 0.15, centre + r(-.02, .02)}, 1000),
             1000);
}

void pit(System& s, double half) {
  s.add_ground();
  s.add_box({0.5, 4, half + 1}, {-half - 0.5, 4, 0}, 0);
  s.add_box({0.5, 4, half + 1}, {half + 0.5, 4, 0}, 0);
  s.add_box({half, 4, 0.5}, {0, 4, -half - 0.5}, 0);
  s.add_box({half, 4, 0.5}, {0, 4, half + 0.5}, 0);
}

std::vector<Vec3> stone(Random& r) {
  std::vector<Vec3> points;
  for (int i = 0; i < 14; ++i) {
    const Vec3 v = normalized(Vec3{r(-1, 1), r(-1, 1), r(-1, 1)});
    points.push_back({0.2 * v.x, 0.14 * v.y, 0.16 * v.z});
  }
  return points;
}

Vec3 pile_place(Random& r, int i) {
  return {-0.75 + 0.5 * (i % 4) + r(-.05, .05), 0.4 + 0.5 * (i / 16),
          -0.75 + 0.5 * (i / 4 % 4) + r(-.05, .05)};
}

void pile(Scene& scene, Random& r, double count, bool hulls) {
  pit(scene.system, 1.2);
  for (int i = 0; i < count; ++i) {
    const Quat turn = rotation({r(-2, 2), r(-2, 2), r(-2, 2)});
    if (hulls)
      scene.system.add_hull(stone(r), pile_place(r, i), 1000, turn);
    else
      scene.system.add_box({r(.08, .2), r(.08, .2), r(.08, .2)}, pile_place(r, i), 1000, turn);
  }
  scene.stands = false;
}

void box_pile(Scene& scene, Random& r, double count) {
  pile(scene, r, count, false);
}
void hull_pile(Scene& scene, Random& r, double count) {
  pile(scene, r, count, true);
}

}  // namespace

const std::vector<Family>& contact_families() {
  static const std::vector<Family> list{
      {"stack", one_stack, {12, 25, 50, 100}},
      {"stacks", fourteen_stacks, {12}},
      {"wall", wall, {4, 8, 20}},
      {"round-tower", round_tower, {10}},
      {"jenga", jenga, {18}},
      {"cards", cards, {2, 3, 4}},
      {"boards", boards, {1}},
      {"table", table, {100, 1000}},
      {"tip", tipping_table, {1000}},
      {"heavy", heavy_on_light, {10, 100, 1000, 10000}},
      {"drop", heavy_drop, {1000}},
      {"plate", plate_on_boxes, {3, 6}},
      {"pile", box_pile, {50, 100, 200}},
      {"stones", hull_pile, {50, 100, 200}},
  };
  return list;
}

}  // namespace lockstone::bench::trial
