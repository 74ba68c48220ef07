// Piles, which must come to rest and sleep.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

std::vector<Triple> stone(SceneMaker& m, double size) {
  std::vector<Triple> points;
  const int n = m.random.count(6, 16);
  for (int i = 0; i < n; ++i) {
    const double far = size * m.random.between(0.8, 1);
    points.push_back(far * m.direction());
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {  // never flat
    Triple point{};
    point[axis] = size;
    points.push_back(point);
    point[axis] = -size;
    points.push_back(point);
  }
  return points;
}

Triple place(SceneMaker& m, int i, double pitch, int side) {
  const int layer = i / (side * side), cell = i % (side * side);
  const double middle = 0.5 * (side - 1);
  return Triple{pitch * (cell % side - middle), pitch * (layer + 1.0),
                pitch * (cell / side - middle)} +
         m.jitter(0.1 * pitch);
}

void walls(SceneMaker& m, double half, double high) {
  for (const double side : {-1.0, 1.0}) {
    m.fix(m.box({0.5, high, half + 1}, {side * (half + 0.5), high, 0}));
    m.fix(m.box({half + 1, high, 0.5}, {0, high, side * (half + 0.5)}));
  }
}

// Random hulls fall through a funnel of four slanted slabs into a pit.
void fill_funnel(SceneMaker& m) {
  const int n = m.count(20, 200);
  const double size = m.random.between(0.12, 0.25);
  m.ground();
  walls(m, 1.5, 1.5);
  for (int side = 0; side < 4; ++side) {
    const Turn about = turn_about({0, 1, 0}, side * std::numbers::pi / 2);
    const Turn tilt = about * turn_about({0, 0, 1}, 0.7);
    const int slab = m.box({2.5, 0.1, 5}, turned(about, {3, 4.5, 0}));
    m.fix(slab);
    m.turn(slab, tilt);
  }
  for (int i = 0; i < n; ++i) {
    Triple at = place(m, i, 2.4 * size, 6);
    at[1] += 5;
    const int hull = m.hull(stone(m, size), at, 2000);
    m.turn(hull, m.any_turn());
  }
  heap(m, 20);
}

// Stones on a floor.
void fill_gravel(SceneMaker& m) {
  const int n = m.count(10, 150);
  const double size = m.random.between(0.05, 0.2);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const Triple at = place(m, i, 2.2 * size, 5);
    const int hull = m.hull(stone(m, size * m.random.between(0.6, 1)), at, 2000);
    m.turn(hull, m.any_turn());
  }
  m.set_friction(m.random.between(0.3, 0.9));
  heap(m, 12);
}

// Balls in a box.
void fill_balls(SceneMaker& m) {
  const int n = m.count(40, 250), side = m.random.count(3, 6);
  const double r = m.random.between(0.1, 0.4);
  m.ground();
  walls(m, 2.1 * r * side / 2 + r, 10 * r);
  const double spread = m.random.chance(0.5) ? 1 : 0.6;
  for (int i = 0; i < n; ++i) {
    const Triple at = place(m, i, 2.1 * r, side);
    m.ball(r * m.random.between(spread, 1), at);
  }
  heap(m, 15);
}

// Boxes in a pile.
void crate_pile(SceneMaker& m, int n, int side) {
  m.ground();
  for (int i = 0; i < n; ++i) {
    const Triple at = place(m, i, 0.9, side);
    const Triple half{m.random.between(0.1, 0.4), m.random.between(0.1, 0.4),
                      m.random.between(0.1, 0.4)};
    m.turn(m.box(half, at), m.any_turn());
  }
  heap(m, 15);
}

void fill_crates(SceneMaker& m) {
  const int n = m.count(10, 150);
  crate_pile(m, n, m.random.count(2, 5));
}

// Through 256 bodies, where our solver changes its method.
void fill_big_pile(SceneMaker& m) {
  const int n = m.count(220, 320);
  crate_pile(m, n, m.random.count(5, 7));
}

void fill_ragdolls(SceneMaker& m) {
  const int n = m.count(1, 12);
  m.ground();
  for (int i = 0; i < n; ++i)
    add_ragdoll(m, Triple{0.7 * (i % 2), 1.3 + 1.5 * (i / 2), 0} + m.jitter(0.2));
  m.set_friction(0.6);
  heap(m, 15);
}

std::vector<Triple> prism_of(int corners, double r, double half) {
  std::vector<Triple> prism;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    for (const double y : {-half, half})
      prism.push_back({r * std::cos(angle), y, r * std::sin(angle)});
  }
  return prism;
}

// Thin plates or discs fall onto each other.
void fill_plates(SceneMaker& m) {
  const int n = m.count(2, 100);
  const double size = m.random.between(0.2, 0.6), thick = size / m.random.log_between(10, 50);
  const bool are_discs = m.random.chance(0.3);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const Triple at = place(m, i, (are_discs ? 1.6 : 1.5) * size, 2);
    const double wide = size * m.random.between(0.5, 1), deep = size * m.random.between(0.5, 1);
    const int plate =
        are_discs ? m.hull(prism_of(8, size, thick), at, 1000) : m.box({wide, thick, deep}, at);
    const Turn any = m.any_turn(), roll = turn_about({1, 0, 0}, m.random.between(-0.2, 0.2));
    m.turn(plate, m.random.chance(0.5) ? any : roll);
  }
  m.set_friction(m.random.between(0.2, 0.9));
  heap(m, 15);
}

// Tetrahedra, some of them flat.
void fill_tetrahedra(SceneMaker& m) {
  const int n = m.count(2, 120);
  const double size = m.random.between(0.08, 0.3), flat = m.random.log_between(0.1, 1);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const double s = size * m.random.between(0.6, 1), h = flat * s;
    const int hull = m.hull({{s, h, s}, {s, -h, -s}, {-s, h, -s}, {-s, -h, s}},
                            place(m, i, 2.6 * size, 3), 1000);
    m.turn(hull, m.any_turn());
  }
  m.set_friction(m.random.between(0.2, 0.9));
  heap(m, 15);
}

// Stones stacked as a pyramid of hulls with flat faces: eight-sided prisms.
void fill_hull_pyramid(SceneMaker& m) {
  const int rows = m.count(2, 12);
  const double r = m.random.between(0.2, 0.4), half = m.random.between(0.1, 0.3);
  const int corners = m.random.count(5, 9);
  const std::vector<Triple> prism = prism_of(corners, r, half);
  m.ground();
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i)
      m.hull(prism, {2.02 * r * (i + 0.5 * row), half * (2 * row + 1), 0});
  }
  heap(m, 12);
}

}  // namespace

void add_ragdoll(SceneMaker& m, const Triple& at) {
  const int trunk = m.box({0.2, 0.3, 0.12}, at);
  const int head = m.ball(0.13, at + Triple{0, 0.45, 0});
  m.join(Link::ball, trunk, head, at + Triple{0, 0.31, 0});
  for (const double side : {-1.0, 1.0}) {
    for (const double low : {0.0, 1.0}) {
      const Triple top = at + Triple{side * (low > 0 ? 0.12 : 0.28), low > 0 ? -0.35 : 0.25, 0};
      const int upper = m.capsule(0.06, 0.1, top + Triple{0, -0.16, 0});
      const int lower = m.capsule(0.05, 0.1, top + Triple{0, -0.45, 0});
      m.join(Link::ball, trunk, upper, top);
      GeneralJoint& knee = m.join(Link::hinge, upper, lower, top + Triple{0, -0.3, 0}, {1, 0, 0});
      knee.limited = true;
      knee.lower = 0;
      knee.upper = 2.4;
    }
  }
}

void add_rest_families(std::vector<Family>& all) {
  all.insert(all.end(), {{"funnel", "20-200 random hulls through a funnel into a pit", fill_funnel},
                         {"gravel", "10-150 random hulls on a floor", fill_gravel},
                         {"balls", "40-250 balls in a box", fill_balls},
                         {"crates", "10-150 boxes in a pile", fill_crates},
                         {"big-pile", "220-320 boxes in a pile", fill_big_pile},
                         {"plates", "2-100 thin plates or discs in a pile", fill_plates},
                         {"tetrahedra", "2-120 tetrahedra in a pile", fill_tetrahedra},
                         {"ragdolls", "1-12 ragdolls in a pile", fill_ragdolls},
                         {"hull-pyramid", "2-12 rows of prisms", fill_hull_pyramid}});
}

}  // namespace lockstone::bench
