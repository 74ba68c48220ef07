// Jointed bodies that strike or are struck: wrecking balls, ragdolls, catapults, bridges, doors.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

// A ball on a chain swings into a wall of bricks.
void fill_wrecking_ball(SceneMaker& m) {
  const int wide = m.count(2, 9), high = m.count(2, 9), links = m.count(1, 14);
  const double radius = m.random.between(0.25, 0.6), half = m.random.between(0.08, 0.2);
  const double angle = m.random.between(0.6, 1.7), length = 2 * half * links + radius;
  m.ground();
  for (int row = 0; row < high; ++row) {
    for (int i = 0; i < wide; ++i)
      m.box({0.125, 0.1, 0.25}, {0.3, 0.2 * row + 0.1, 0.505 * (i - 0.5 * wide + (row % 2) * 0.5)},
            m.random.between(500, 2500));
  }
  const Triple top{-radius, length + radius + m.random.between(0.02, 0.5), 0};
  const Triple along{-std::sin(angle), -std::cos(angle), 0};
  int before = m.anchor(top);
  for (int i = 0; i < links; ++i) {
    const int link = m.capsule(0.04, half - 0.04, top + (2 * i + 1) * half * along, 7800);
    m.turn(link, turn_about({0, 0, 1}, -angle));
    m.join(Link::ball, before, link, top + 2 * i * half * along);
    before = link;
  }
  const int ball = m.ball(radius, top + length * along, m.random.log_between(200, 8000));
  m.join(Link::ball, before, ball, top + 2 * half * links * along);
  m.set_friction(m.random.between(0.3, 0.9));
  m.judge(Judge::gap, 0.02, 6);
}

void stairs(SceneMaker& m) {
  for (int i = 0; i < 8; ++i)
    m.fix(m.box({0.15, 0.1 * (i + 1), 3}, {2 + 0.3 * i, 0.1 * (i + 1), 0}));
  m.fix(m.box({0.5, 3, 3}, {4.9, 3, 0}));
}

// Ragdolls thrown at stairs and a wall.
void fill_ragdoll_throw(SceneMaker& m) {
  const int n = m.count(1, 6);
  const double speed = m.random.log_between(3, 40);
  m.ground();
  stairs(m);
  for (int i = 0; i < n; ++i) {
    const auto first = m.scene.bodies.size();
    add_ragdoll(m, Triple{-1.5 * i, m.random.between(1.2, 2.2), 0} + m.jitter(0.2));
    const Triple way = Triple{speed, 0, 0} + m.jitter(0.2 * speed);
    for (auto k = first; k < m.scene.bodies.size(); ++k)
      m.scene.bodies[k].velocity = way;
  }
  m.set_friction(m.random.between(0.3, 0.8));
  m.judge(Judge::gap, 0.05, 4);
}

// A ragdoll hangs by a hand and is shot at.
void fill_ragdoll_hung(SceneMaker& m) {
  const Triple at{0, 3, 0};
  m.ground();
  const auto first = static_cast<int>(m.scene.bodies.size());
  add_ragdoll(m, at);
  const int hand = first + m.random.count(1, 9);
  m.join(Link::ball, m.anchor(m.body(hand).position), hand, m.body(hand).position);
  const int shots = m.count(1, 12);
  for (int i = 0; i < shots; ++i) {
    const double speed = m.random.log_between(10, 150), r = m.random.between(0.03, 0.12);
    const Triple target = at + m.jitter(0.5), way = m.direction();
    const double far = speed * (0.5 + 0.4 * i);
    const int ball =
        m.ball(r, target - far * Triple{way[0], 0, way[2]}, m.random.log_between(300, 8000));
    m.body(ball).velocity = {speed * way[0], 9.81 / 2 * (0.5 + 0.4 * i), speed * way[2]};
  }
  m.set_friction(0.5);
  m.scene.low = -30;
  m.judge(Judge::gap, 0.05, 6);
}

// A heavy weight throws a ball by a beam.
void fill_catapult(SceneMaker& m) {
  const double arm = m.random.between(0.8, 2), back = m.random.between(0.2, 0.6), y = arm;
  const double angle = m.random.between(0.3, 0.8);
  const Triple pivot{0, y, 0}, along{std::cos(angle), -std::sin(angle), 0};
  const Turn turn = turn_about({0, 0, 1}, -angle);
  m.ground();
  const int beam = m.box({0.5 * (arm + back), 0.04, 0.1}, pivot + 0.5 * (arm - back) * along, 600);
  m.turn(beam, turn);
  m.join(Link::hinge, m.anchor(pivot), beam, pivot);
  const double r = m.random.between(0.05, 0.15);
  const Triple up{std::sin(angle), std::cos(angle), 0};
  const int ball = m.ball(r, pivot + (arm - 1.3 * r) * along + (0.04 + r) * up, 1000);
  const double side = m.random.between(0.1, 0.4);
  const Triple end = pivot - back * along;
  const bool hung = m.random.chance(0.5);
  const int weight = m.box({side, side, side}, end - Triple{0, hung ? side + 0.2 : 0, 0});
  m.set_mass(weight, mass_of(m.body(beam)) * arm / back * m.random.log_between(2, 300));
  m.join(hung ? Link::hinge : Link::weld, beam, weight, end);
  for (const double way : {-1.0, 1.0}) {
    const Triple rim = pivot + (arm - 1.3 * r + 1.2 * way * r) * along + (0.04 + 0.5 * r) * up;
    const int lip = m.box({0.15 * r, 0.5 * r, 0.1}, rim, 600);
    m.turn(lip, turn);
    m.join(Link::weld, beam, lip, rim);
  }
  m.watch(ball);
  m.set_friction(m.random.between(0.2, 0.8));
  m.judge(Judge::gap, 0.01, 4);
}

// Heavy boxes thrown down on a bridge of planks.
void fill_bridge_hit(SceneMaker& m) {
  const int n = m.count(3, 24), boxes = m.count(1, 8);
  const double pitch = m.random.between(0.3, 0.6), y = 0.3 * n * pitch + 1;
  const double speed = m.random.log_between(2, 25);
  const Link link = m.random.chance(0.5) ? Link::hinge : Link::ball;
  m.ground();
  int before = m.anchor({0, y, 0});
  for (int i = 0; i <= n; ++i) {
    const int plank = i == n ? m.anchor({n * pitch, y, 0})
                             : m.box({0.47 * pitch, 0.04, 0.5}, {(i + 0.5) * pitch, y, 0}, 600);
    if (link == Link::hinge) m.join(link, before, plank, {i * pitch, y, 0});
    if (link == Link::ball)
      for (const double z : {-0.4, 0.4})
        m.join(link, before, plank, {i * pitch, y, z});
    before = plank;
  }
  for (int i = 0; i < boxes; ++i) {
    const double half = m.random.between(0.1, 0.3);
    const Triple at{n * pitch * m.random.between(0.2, 0.8), y + 1 + 0.8 * i,
                    m.random.between(-0.2, 0.2)};
    const int box = m.box({half, half, half}, at, m.random.log_between(200, 8000));
    m.turn(box, m.any_turn());
    m.body(box).velocity = Triple{0, -speed, 0} + m.jitter(0.2 * speed);
  }
  m.set_friction(0.7);
  m.judge(Judge::gap, 0.05, 5);
}

// Balls shot at doors on two hinges, with or without stops.
void fill_door_hit(SceneMaker& m) {
  const int shots = m.count(1, 20);
  const double speed = m.random.log_between(5, 200);
  const bool stops = m.random.chance(0.5);
  m.ground();
  const int door = m.box({0.45, 1, 0.03}, {0.5, 1.05, 0}, m.random.log_between(100, 2000));
  const int frame = m.anchor({0, 1, 0});
  for (const double y : {0.3, 1.8}) {
    GeneralJoint& hinge = m.join(Link::hinge, frame, door, {0, y, 0}, {0, 1, 0});
    hinge.limited = stops;
    hinge.lower = -m.random.between(0, 1.6);
    hinge.upper = m.random.between(0, 1.6);
  }
  for (int i = 0; i < shots; ++i) {
    const double r = m.random.between(0.02, 0.1);
    const double when = 0.3 + m.random.between(0.05, 0.3) * i;
    const Triple at{m.random.between(0.1, 0.9), m.random.between(0.3, 1.8), 1 + speed * when};
    const int ball = m.ball(r, at, m.random.log_between(500, 8000));
    m.body(ball).velocity = {0, 9.81 / 2 * when, -speed};
    m.body(ball).bullet = true;
  }
  m.set_friction(0.5);
  m.scene.low = -50;
  m.judge(Judge::gap, 0.01, 5);
}

// Heavy plates dropped on their edges onto rods.
void fill_edge_drop(SceneMaker& m) {
  const int plates = m.count(1, 8), rods = m.count(1, 24);
  const double ratio = m.random.log_between(1, 1000), high = m.random.between(0.5, 4);
  m.ground();
  for (int i = 0; i < rods; ++i) {
    const double r = m.random.between(0.01, 0.08);
    const Triple at{0.2 * (i % 6) - 0.5, r + 0.2 * (i / 6), m.random.between(-0.2, 0.2)};
    const int rod =
        m.random.chance(0.5) ? m.capsule(r, 0.5, at, 1000) : m.box({r, 0.5, r}, at, 1000);
    m.turn(rod, turn_about({1, 0, m.random.between(-0.3, 0.3)}, std::numbers::pi / 2));
  }
  for (int i = 0; i < plates; ++i) {
    const double size = m.random.between(0.2, 0.6), thick = size / m.random.log_between(4, 60);
    const Triple at{m.random.between(-0.5, 0.5), high + 1 + 1.3 * i, m.random.between(-0.3, 0.3)};
    const int plate = m.box({size, size, thick}, at, 1000);
    m.set_density(plate, 500 * m.random.log_between(1, ratio));
    m.turn(plate, turn_about({0, 1, 0}, m.random.between(0, 3)) *
                      turn_about({0, 0, 1}, m.random.chance(0.5) ? 0 : m.random.between(0, 1)));
    m.body(plate).velocity = {0, -m.random.between(0, 10), 0};
  }
  m.set_friction(m.random.between(0.1, 0.9));
  m.judge(Judge::gain, 0.05, 5);
}

// A car of four driven wheels over loose rubble.
void fill_rubble(SceneMaker& m) {
  const int n = m.count(3, 60);
  const double radius = m.random.between(0.25, 0.4), y = radius + 0.15;
  const double speed = m.random.between(1, 8), spread = m.random.log_between(1, 100);
  m.ground();
  const int chassis = m.box({1, 0.12, 0.4}, {0, y + 0.1, 0}, 600);
  const double effort = mass_of(m.body(chassis)) * m.random.log_between(1, 30);
  for (const double x : {-0.75, 0.75}) {
    for (const double z : {-0.6, 0.6}) {
      const int wheel = m.ball(radius, {x, radius, z}, 500);
      GeneralJoint& axle = m.join(Link::hinge, chassis, wheel, {x, radius, z}, {0, 0, 1});
      axle.speed = -speed / radius;
      axle.effort = effort;
    }
  }
  for (int i = 0; i < n; ++i) {
    const double half = m.random.between(0.04, 0.2);
    const Triple at{1.8 + 0.35 * (i / 4), 0.2 + m.random.between(0, 0.2), 0.45 * (i % 4 - 1.5)};
    const double density = 100 * m.random.log_between(1, spread);
    const int body = m.random.chance(0.6)
                         ? m.box({half, half * m.random.between(0.3, 1), half}, at, density)
                         : m.capsule(0.5 * half, half, at, density);
    m.turn(body, m.any_turn());
  }
  m.set_friction(m.random.between(0.4, 1));
  m.scene.passive = false;
  m.judge(Judge::fastest, 25, 8);
}

}  // namespace

void add_strike_families(std::vector<Family>& all) {
  all.insert(
      all.end(),
      {{"wrecking-ball", "a ball on a chain swings into a wall of bricks", fill_wrecking_ball},
       {"ragdoll-throw", "1-6 ragdolls thrown at stairs, 3-40 m/s", fill_ragdoll_throw},
       {"ragdoll-hung", "a ragdoll hung by a limb, shot at", fill_ragdoll_hung},
       {"catapult", "a weight throws a ball by a beam", fill_catapult},
       {"bridge-hit", "heavy boxes thrown on a bridge", fill_bridge_hit},
       {"door-hit", "balls shot at a door on two hinges", fill_door_hit},
       {"edge-drop", "heavy plates dropped edge-on onto rods", fill_edge_drop},
       {"rubble", "a car drives over loose rubble", fill_rubble}});
}

}  // namespace lockstone::bench
