// Walls, belts, drums, trays, lifts and presses that move heaps of bodies.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

int kinematic(SceneMaker& m, int body) {
  m.body(body).motion = Motion::kinematic;
  m.scene.passive = false;
  return body;
}

// Two walls close in on a pile, stop, and part again.
void fill_closing_walls(SceneMaker& m) {
  const int n = m.count(2, 80), side = m.random.count(2, 4);
  const double size = m.random.between(0.1, 0.3), spread = m.random.log_between(1, 100);
  const double half = 1.15 * size * side, speed = m.random.log_between(0.1, 3);
  const double left = m.random.between(0.05, 0.7) * half;
  m.ground();
  for (const double way : {-1.0, 1.0})
    m.fix(m.box({3 * half, 5, 0.5}, {0, 5, way * (half + 0.55)}));
  for (const double way : {-1.0, 1.0}) {
    const int wall = kinematic(m, m.box({0.3, 5, half}, {way * (half + 0.4), 5, 0}));
    m.body(wall).velocity = {-way * speed, 0, 0};
    const int stop = static_cast<int>(60 * (half - left) / speed);
    m.scene.moves.push_back({stop, wall, {}, {}});
    m.scene.moves.push_back({stop + 120, wall, {way * speed, 0, 0}, {}});
    m.scene.moves.push_back({stop + 180, wall, {}, {}});
    m.judge(Judge::fastest, 20, (stop + 300) / 60.0);
  }
  for (int i = 0; i < n; ++i) {
    const int body =
        any_body(m, size, cell(i, side, 2.2 * size), 200 * m.random.log_between(1, spread));
    if (m.random.chance(0.5)) m.turn(body, m.any_turn());
  }
  m.set_friction(m.random.between(0.2, 0.9));
}

// Bodies fall on a belt one after the other, which throws them into a bin.
void fill_belt(SceneMaker& m) {
  const int n = m.count(3, 60), every = m.random.count(4, 20);
  const double size = m.random.between(0.08, 0.25), speed = m.random.between(0.5, 5);
  const double spread = m.random.log_between(1, 300), tilt = m.random.between(-0.2, 0.3);
  m.ground();
  const Turn turn = turn_about({0, 0, 1}, tilt);
  const int belt = m.box({2, 0.1, 0.5}, {0, 2, 0});
  m.fix(belt);
  m.turn(belt, turn);
  m.body(belt).surface = {speed, 0, 0};
  for (const double way : {-1.0, 1.0}) {
    const int rail = m.box({2, 0.4, 0.05}, {0, 2.2, way * 0.55});
    m.fix(rail);
    m.turn(rail, turn);
    m.fix(m.box({0.2, 3, 1}, {3.6 + way * 1.6, way < 0 ? -1.9 : 3, 0}));
    m.fix(m.box({1.8, 3, 0.2}, {3.6, 3, way * 0.9}));
  }
  for (int i = 0; i < n; ++i) {
    const Triple at = Triple{-1.2, 2.6 + size, 0} + m.jitter(0.15);
    const int body = any_body(m, size, at, 100 * m.random.log_between(1, spread));
    m.turn(body, m.any_turn());
    m.body(body).from = i * every;
    m.watch(body);
  }
  m.set_friction(m.random.between(0.3, 0.9));
  m.scene.passive = false;
  m.judge(Judge::fastest, 20, n * every / 60.0 + 5);
}

// A drum of twelve slabs turns about its axis, with bodies of mixed masses in it.
void fill_drum(SceneMaker& m) {
  const int n = m.count(2, 80), side = m.random.count(2, 4);
  const double size = m.random.between(0.08, 0.25), spread = m.random.log_between(1, 1000);
  const double layers = 1.0 + n / (side * side);
  const double r = 2.2 * size * std::max(layers, 1.0 * side) * 0.75 + 0.3, deep = 1.2 * size * side;
  GeneralBody drum;
  drum.form = Form::compound;
  for (int i = 0; i < 12; ++i) {
    const Turn turn = turn_about({0, 0, 1}, i * std::numbers::pi / 6);
    drum.parts.push_back(slab({0.3 * r, 0.2, deep}, turned(turn, {0, -r - 0.2, 0}), turn));
  }
  for (const double way : {-1.0, 1.0})
    drum.parts.push_back(slab({1.3 * r, 1.3 * r, 0.2}, {0, 0, way * (deep + 0.2)}));
  if (m.random.chance(0.5))
    drum.parts.push_back(slab({0.02, 0.15 * r, deep}, {0, -0.85 * r, 0}));  // a baffle
  drum.angular_velocity = {0, 0, m.random.log_between(0.3, 8)};
  kinematic(m, m.add(drum));
  for (int i = 0; i < n; ++i) {
    const Triple at = cell(i, side, 2.1 * size) - Triple{-0.1 * r, 0.55 * r, 0};
    m.watch(any_body(m, size, at, 100 * m.random.log_between(1, spread)));
  }
  m.set_friction(m.random.between(0.2, 0.9));
  m.scene.expected = 1.1 * r;
  m.judge(Judge::outside, 0.01, 6);
}

// Marbles in a tray that tilts to and fro.
void fill_tray(SceneMaker& m) {
  const int n = m.count(3, 120), side = m.random.count(3, 6);
  const double size = m.random.log_between(0.004, 0.03), half = 2.6 * size * side;
  const double tilt = m.random.between(0.05, 0.5), turns = m.random.between(1, 6);
  const double high = 2.4 * size * (2.0 + n / (side * side)) + 0.03;
  GeneralBody tray;
  tray.form = Form::compound;
  tray.parts.push_back(slab({half + 0.02, 0.01, half + 0.02}, {0, -0.01, 0}));
  for (const double way : {-1.0, 1.0}) {
    tray.parts.push_back(slab({0.01, high, half}, {way * (half + 0.01), high, 0}));
    tray.parts.push_back(slab({half, high, 0.01}, {0, high, way * (half + 0.01)}));
  }
  const int body = kinematic(m, m.add(tray));
  const double balls = m.random.chance(0.6) ? 1 : m.random.between(0, 1);
  for (int i = 0; i < n; ++i) {
    const double r = size * m.random.between(0.5, 1);
    const Triple at = cell(i, side, 2.2 * size);
    m.watch(m.random.chance(balls) ? m.ball(r, at, 2500) : m.box({r, r, r}, at, 2500));
  }
  const double phase = m.random.between(0, 6);
  for (int tick = 30; tick < 330; ++tick) {
    const double now = turns * (tick - 30) / 60, next = turns * (tick - 29) / 60;
    const double x = tilt * (std::sin(next) - std::sin(now));
    const double z = tilt * (std::sin(1.3 * next + phase) - std::sin(1.3 * now + phase));
    m.scene.moves.push_back({tick, body, {}, {60 * x, 0, 60 * z}});
  }
  m.scene.moves.push_back({330, body, {}, {}});
  m.set_friction(m.random.between(0.1, 0.6));
  m.scene.expected = 1.5 * half + 2 * high;
  m.judge(Judge::outside, 0, 7);
}

// Stacks of mixed masses in a lift that starts and stops, up and down.
void fill_elevator(SceneMaker& m) {
  const int stacks = m.count(1, 6), high = m.count(2, 8);
  const double spread = m.random.log_between(1, 3000), share = m.random.between(0.1, 0.8);
  const double speed = m.random.between(0.3, 4);
  const int lift = kinematic(m, m.box({3, 0.2, 3}, {0, -0.2, 0}));
  for (int i = 0; i < stacks; ++i) {
    double top = 0;
    for (int k = 0; k < high; ++k) {
      const double half = m.random.between(0.1, 0.25), wide = m.random.between(0.25, 0.35);
      m.box({wide, half, wide}, {1.2 * (i % 3 - 1), top + half, 1.2 * (i / 3)},
            50 * m.random.log_between(1, spread));
      top += 2 * half;
    }
  }
  const int ramp = 1 + static_cast<int>(60 * speed / (9.81 * share));
  for (int k = 0; k < 4; ++k) {
    const double sign = k < 2 ? 1 : -1;
    for (int i = 1; i <= ramp; ++i) {
      const double part = sign * (k % 2 == 0 ? i : ramp - i) / ramp;
      m.scene.moves.push_back({60 + k * (ramp + 30) + i, lift, {0, part * speed, 0}, {}});
    }
  }
  m.set_friction(m.random.between(0.3, 0.8));
  m.scene.expected = 1;
  m.judge(Judge::displacement, 0.02, (4.0 * (ramp + 30) + 180) / 60);
}

// A motor presses a plate on a pile in a pen, with up to a thousand times the pile's weight.
void fill_press(SceneMaker& m) {
  const int n = m.count(1, 40), side = m.random.count(1, 3);
  const double size = m.random.between(0.1, 0.3), half = 1.15 * size * side;
  const double top = 2.2 * size * (1 + (n - 1) / (side * side));
  m.ground();
  for (const double way : {-1.0, 1.0}) {
    m.fix(m.box({0.5, 4, half + 1}, {way * (half + 0.5), 4, 0}));
    m.fix(m.box({half + 1, 4, 0.5}, {0, 4, way * (half + 0.5)}));
  }
  double weight = 0;
  for (int i = 0; i < n; ++i) {
    const int body =
        any_body(m, size, cell(i, side, 2.2 * size), 200 * m.random.log_between(1, 30));
    weight += 9.81 * mass_of(m.body(body));
    if (m.random.chance(0.5)) m.turn(body, m.any_turn());
  }
  const Triple at{0, top + 0.5, 0};
  const int plate = m.box({half - 0.02, 0.1, half - 0.02}, at, 2000);
  const int frame = m.anchor(at);
  GeneralJoint& slider = m.join(Link::slider, frame, plate, at, {0, 1, 0});
  slider.speed = -m.random.between(0.1, 2);
  slider.effort = 9.81 * mass_of(m.body(plate)) + weight * m.random.log_between(1, 1000);
  m.set_friction(m.random.between(0.2, 0.9));
  m.scene.passive = false;
  m.judge(Judge::fastest, 20, 8);
}

// A hand drags a crate by a spring through other crates, and into a wall.
void fill_drag(SceneMaker& m) {
  const int n = m.count(0, 20);
  const double speed = m.random.log_between(0.3, 10), half = m.random.between(0.2, 0.4);
  m.ground();
  m.fix(m.box({0.3, 2, 4}, {4, 2, 0}));
  const int crate = m.box({half, half, half}, {-3, half, 0}, m.random.log_between(50, 3000));
  const Triple hand{-3, half * m.random.between(0.5, 3), m.random.between(-0.3, 0.3)};
  const int hold = kinematic(m, m.anchor(hand));
  GeneralJoint& spring = m.rod(hold, crate, hand, Triple{-3, half, 0} + m.jitter(0.9 * half));
  spring.hertz = m.random.log_between(0.5, 20);
  spring.damping = m.random.between(0.05, 1.5);
  spring.target = m.random.between(0.02, 0.5);
  for (int i = 0; i < n; ++i) {
    const double other = m.random.between(0.1, 0.25);
    m.box({other, other, other},
          {-2 + 0.6 * (i % 8), other + 0.5 * (i / 8), m.random.between(-0.3, 0.3)},
          m.random.log_between(50, 3000));
  }
  const int stop = static_cast<int>(60 * m.random.between(6, 9) / speed);
  m.scene.moves = {{30, hold, {speed, 0, 0}, {}}, {30 + stop, hold, {}, {}}};
  m.set_friction(m.random.between(0.2, 0.9));
  m.judge(Judge::fastest, 4 * speed + 12, (stop + 240) / 60.0);
}

}  // namespace

void add_driven_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"closing-walls", "walls close in on 2-80 bodies and part again", fill_closing_walls},
              {"belt", "a belt throws 3-60 bodies into a bin", fill_belt},
              {"drum", "2-80 bodies in a drum that turns, up to 1000 : 1", fill_drum},
              {"tray", "3-120 marbles of 2-30 mm in a tray that tilts", fill_tray},
              {"elevator", "stacks of mixed masses in a lift that starts and stops", fill_elevator},
              {"press", "a motor presses 1-40 bodies, up to 1000 times their weight", fill_press},
              {"drag", "a crate on a spring, dragged through crates into a wall", fill_drag}});
}

}  // namespace lockstone::bench
