// Structures that only friction holds.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;
constexpr double k_degree = std::numbers::pi / 180;

// Two boards edge to edge, each leaning by an angle towards the other; returns their height.
double lean(SceneMaker& m, double x, double y, double half, double thick, double deep,
            double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  for (const double side : {-1.0, 1.0}) {
    // The upper inner corner is at x, the lowest corner at y.
    const double out = half * s + thick * c, up = half * c + thick * s;
    const int board = m.box({thick, half, deep}, {x + side * out, y + up, 0});
    m.turn(board, turn_about({0, 0, 1}, side * angle));
  }
  return 2 * (half * c + thick * s);
}

void fill_leaning_boards(SceneMaker& m) {
  const double half = m.random.between(0.15, 0.5), thick = half * m.random.between(0.015, 0.05);
  m.ground();
  lean(m, 0, 0, half, thick, 0.7 * half, m.random.between(8, 26) * k_degree);
  m.set_friction(m.random.between(0.6, 0.8));
  m.judge(Judge::displacement, 0.003, 15);
}

void fill_cards(SceneMaker& m) {
  const int floors = m.count(2, 6);
  const double angle = m.random.between(15, 25) * k_degree, half = 0.5, thick = 0.01;
  const double pitch = 4 * (half * std::sin(angle) + thick * std::cos(angle)) + 0.02;
  m.ground();
  double y = 0;
  for (int floor = 0; floor < floors; ++floor) {
    const int pairs = floors - floor;
    double high = 0;
    for (int i = 0; i < pairs; ++i)
      high = lean(m, pitch * (i + 0.5 * floor), y, half, thick, 0.35, angle);
    y += high;
    if (pairs == 1) break;
    for (int i = 0; i + 1 < pairs; ++i)
      m.box({0.49 * pitch, thick, 0.35}, {pitch * (i + 0.5 * floor + 0.5), y + thick, 0});
    y += 2 * thick;
  }
  m.set_friction(m.random.between(0.6, 0.8));
  m.judge(Judge::displacement, 0.05, 12);
}

// Crates on a slope below the angle of friction, some upon others.
void fill_slope(SceneMaker& m) {
  const double friction = m.random.between(0.3, 0.9);
  const double angle = std::atan(friction) * m.random.between(0.5, 0.95);
  const Turn tilt = turn_about({0, 0, 1}, angle);
  const int slope = m.box({20, 0.5, 20}, turned(tilt, {0, -0.5, 0}));
  m.fix(slope);
  m.turn(slope, tilt);
  const int n = m.count(1, 12);
  const double half = m.random.between(0.2, 0.5);
  for (int i = 0; i < n; ++i) {
    const double along = 4 * half * (i / 3 - 2), high = i % 3 * 0.8 * half;
    const int crate = m.box({half, 0.4 * half, half}, turned(tilt, {along, 0.4 * half + high, 0}));
    m.turn(crate, tilt);
  }
  m.scene.low = -20;
  m.set_friction(friction);
  m.judge(Judge::displacement, 0.01, 10);
}

// A ladder against a wall, with someone on a rung.
void fill_ladder(SceneMaker& m) {
  const double half = m.random.between(1, 2.5), angle = m.random.between(10, 25) * k_degree;
  const double thick = 0.04, s = std::sin(angle), c = std::cos(angle);
  m.ground();
  const double foot = half * s + thick * c;
  m.fix(m.box({0.5, 4, 2}, {-foot - 0.5, 4, 0}));
  const int ladder = m.box({thick, half, 0.25}, {0, half * c + thick * s, 0}, 300);
  m.turn(ladder, turn_about({0, 0, 1}, angle));
  if (m.random.chance(0.7)) {
    const double up = half * m.random.between(-0.8, 0.5);
    const Triple at = m.body(ladder).position + up * Triple{-s, c, 0};
    const int load = m.box({0.2, 0.2, 0.2}, at + Triple{0, 0, 0}, m.random.log_between(100, 4000));
    m.body(load).collides = false;
    m.join(Link::weld, ladder, load, at);
  }
  m.set_friction(m.random.between(0.7, 1));
  m.judge(Judge::displacement, 0.01, 10);
}

// Boards held by the pressure of others alone: a row of books between two heavy ends.
void fill_books(SceneMaker& m) {
  const int n = m.count(3, 20);
  m.ground();
  double x = 0;
  const double tilt = m.random.between(2, 12) * k_degree;
  m.fix(m.box({0.1, 0.5, 0.3}, {-0.1, 0.5, 0}));
  for (int i = 0; i < n; ++i) {
    const double thick = m.random.between(0.02, 0.06), high = m.random.between(0.25, 0.45);
    const double out = high * std::sin(tilt) + thick * std::cos(tilt);
    const double foot = i == 0 ? out : 2 * thick / std::cos(tilt);
    x += i == 0 ? 0 : foot + 0.5 * (high > 0.4 ? 0.0 : 0.002);
    const int book = m.box({thick, high, 0.15},
                           {x + out, high * std::cos(tilt) + thick * std::sin(tilt), 0}, 700);
    m.turn(book, turn_about({0, 0, 1}, tilt));
  }
  m.set_friction(m.random.between(0.5, 0.8));
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.3, 10);
}

// A box pressed between two fixed walls of the right distance by a spring-free wedge: a log pile.
void fill_logs(SceneMaker& m) {
  const int rows = m.count(2, 7);
  const double r = m.random.between(0.1, 0.25), half = m.random.between(0.5, 1.5);
  m.ground();
  const double edge = r * rows + 0.05;
  for (const double side : {-1.0, 1.0})
    m.fix(m.box({0.05, 2 * r * rows, half}, {side * edge, 2 * r * rows, 0}));
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      const double x = r * (2 * i - (rows - row - 1)), y = r * (1 + 1.7320508 * row);
      const int log = m.capsule(r, half, {x, y, 0}, 700);
      m.turn(log, turn_about({1, 0, 0}, 90 * k_degree));
    }
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.3, 10);
}

}  // namespace

void add_friction_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"leaning-boards", "two boards edge to edge, 8-26 degrees", fill_leaning_boards},
              {"cards", "card houses of 2-6 floors, 15-25 degrees", fill_cards},
              {"slope", "1-12 crates on a slope they stand on", fill_slope},
              {"ladder", "against a wall, with a load", fill_ladder},
              {"books", "3-20 books that lean on an end", fill_books},
              {"logs", "2-7 rows of capsules between posts", fill_logs}});
}

}  // namespace lockstone::bench
