// Shelves, tables that are laid, doors.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

// Boards on uprights, with things on each.
void fill_shelf(SceneMaker& m) {
  const int floors = m.count(1, 7), things = m.count(0, 6);
  const double wide = m.random.between(0.5, 1.2), high = m.random.between(0.15, 0.3);
  m.ground();
  double y = 0;
  for (int floor = 0; floor < floors; ++floor) {
    for (const double side : {-1.0, 1.0})
      m.box({0.03, high, 0.2}, {side * (wide - 0.05), y + high, 0}, 700);
    for (int i = 0; i < things; ++i) {
      const double half = high * m.random.between(0.3, 0.9);
      m.box({0.04, half, 0.1}, {0.8 * wide * (2.0 * i / things - 1) + 0.1, y + half, 0},
            m.random.log_between(100, 5000));
    }
    y += 2 * high;
    m.box({wide, 0.02, 0.2}, {0, y + 0.02, 0}, 700);
    y += 0.04;
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.01, 10);
}

// A table made of one piece by welds, with plates, glasses and a pile on it.
void fill_laid_table(SceneMaker& m) {
  const double leg = m.random.between(0.3, 0.45), wide = m.random.between(0.5, 1);
  m.ground();
  const int top = m.box({wide, 0.03, wide}, {0, 2 * leg + 0.03, 0}, 700);
  for (int i = 0; i < 4; ++i) {
    const Triple at{i % 2 ? 0.9 * wide : -0.9 * wide, leg, i / 2 ? 0.9 * wide : -0.9 * wide};
    m.join(Link::weld, top, m.box({0.04, leg, 0.04}, at, 700), at + Triple{0, leg, 0});
  }
  const int n = m.count(1, 20);
  const double y = 2 * leg + 0.06;
  for (int i = 0; i < n; ++i) {
    const double high = m.random.between(0.01, 0.08);
    m.box({0.08, high, 0.08},
          {0.18 * (i % 4 - 1.5) * wide / 0.5, y + high, 0.18 * (i / 4 - 1.5) * wide / 0.5},
          m.random.log_between(200, 10000));
  }
  m.judge(Judge::displacement, 0.005, 10);
}

// A door with limits, kicked.
void fill_door(SceneMaker& m) {
  const double wide = m.random.between(0.3, 0.6), high = m.random.between(0.8, 1.1);
  const int frame = m.anchor({0, high, 0});
  const int door = m.box({wide, high, 0.02}, {wide, high, 0}, 600);
  const bool two = m.random.chance(0.7);  // two hinges on one axis say all twice
  for (const double y : {0.2 * high, 1.8 * high}) {
    if (y > high && !two) continue;
    GeneralJoint& hinge = m.join(Link::hinge, frame, door, {0, y, 0}, {0, 1, 0});
    hinge.limited = true;
    hinge.lower = -m.random.between(0.2, 1.5);
    hinge.upper = 1.5;
  }
  const double speed = m.random.between(1, 15);
  m.body(door).angular_velocity = {0, speed, 0};
  m.body(door).velocity = cross({0, speed, 0}, {wide, 0, 0});
  m.judge(Judge::gap, 0.005, 6);
}

// Four walls, two floors of boards and a roof of one board.
void fill_house(SceneMaker& m) {
  const int floors = m.count(1, 5);
  const double wide = m.random.between(0.6, 1.5);
  m.ground();
  double y = 0;
  for (int floor = 0; floor < floors; ++floor) {
    for (const double side : {-1.0, 1.0}) {
      m.box({0.06, 0.4, wide}, {side * (wide + 0.07), y + 0.4, 0}, 1500);
      m.box({wide, 0.4, 0.06}, {0, y + 0.4, side * (wide - 0.07)}, 1500);
    }
    m.box({wide + 0.2, 0.04, wide + 0.2}, {0, y + 0.84, 0}, 700);
    y += 0.88;
  }
  m.scene.must_rest = true;
  m.judge(Judge::displacement, 0.01, 10);
}

}  // namespace

void add_furniture_families(std::vector<Family>& all) {
  all.insert(all.end(), {{"shelf", "1-7 boards on uprights, things on each", fill_shelf},
                         {"laid-table", "welded table with 1-20 things", fill_laid_table},
                         {"door", "one or two hinges with limits, kicked", fill_door},
                         {"house", "1-5 floors of four walls and a board", fill_house}});
}

}  // namespace lockstone::bench
