// Bodies that fall over, are driven, lifted, or squeezed until nothing can give.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

// The vertices of a prism about y.
std::vector<Triple> prism(int sides, double radius, double half_height) {
  std::vector<Triple> points;
  for (const double y : {-half_height, half_height}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      points.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
    }
  }
  return points;
}

// One body that lands on an end while it turns: its other end comes down faster than it falls.
void fill_topple(SceneMaker& m) {
  const double radius = m.random.log_between(0.03, 0.3), half = radius * m.random.between(1, 6);
  const double wide = radius * m.random.between(1, 3);
  const int kind = m.random.count(0, 2);
  m.ground();
  const double high = half + wide + radius + m.random.between(0, 0.5);
  int body = 0;
  if (kind == 0) body = m.box({radius, half, wide}, {0, high, 0});
  if (kind == 1) body = m.capsule(radius, half, {0, high, 0});
  if (kind == 2) body = m.hull(prism(12, radius, half), {0, high, 0});
  const double lean = m.random.between(0.02, 1.5), about = m.random.between(0, 6);
  m.turn(body, turn_about({std::cos(about), 0, std::sin(about)}, lean));
  const Triple drift = m.jitter(1), turning = m.jitter(8);
  m.body(body).velocity = {drift[0], -m.random.between(0, 3), drift[2]};
  m.body(body).angular_velocity = {turning[0], turning[1] / 4, turning[2]};
  m.set_friction(m.random.between(0, 1));
  m.scene.passive = false;
  m.judge(Judge::sunk, 0.02, 2.5);
}

// A chassis with a body of boards, a load and four wheels, two of them driven, over bumps.
void fill_wagon(SceneMaker& m) {
  const double radius = m.random.between(0.25, 0.35), length = 1.2, width = 0.6;
  const double high = radius + 0.05, speed = m.random.between(1.5, 5);
  const bool round = m.random.chance(0.3);
  m.ground();
  const int chassis = m.box({length, 0.08, width}, {0, high + 0.1, 0}, 800);
  for (const double side : {-1.0, 1.0}) {
    const Triple at{side * (length - 0.04), high + 0.33, 0};
    m.join(Link::weld, chassis, m.box({0.04, 0.15, width}, at, 400), at);
  }
  for (int i = m.count(0, 8); i > 0; --i)
    m.box({0.15, 0.15, 0.15}, {m.random.between(-0.8, 0.8), high + 0.1 + 0.4 * i, 0}, 400);
  const double effort = m.random.log_between(200, 4000);
  for (const double x : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0}) {
      const Triple at{x * 0.75 * length, radius, z * (width + 0.15)};
      const int wheel = round ? m.ball(radius, at, 600) : m.hull(prism(16, radius, 0.08), at, 900);
      m.turn(wheel, turn_about({1, 0, 0}, std::numbers::pi / 2));
      GeneralJoint& axle = m.join(Link::hinge, chassis, wheel, at, {0, 0, 1});
      if (x > 0) continue;
      axle.speed = -speed / radius;
      axle.effort = effort;
    }
  }
  for (int i = m.count(0, 5); i > 0; --i) {
    const double bump = m.random.between(0.1, 0.2);
    const int body = m.capsule(bump, 3, {length + 1.5 * i, -m.random.between(0.4, 0.8) * bump, 0});
    m.fix(body);
    m.turn(body, turn_about({1, 0, 0}, std::numbers::pi / 2));
  }
  m.set_friction(0.8);
  m.scene.passive = false;
  m.judge(Judge::fastest, 20, 8);
}

// A platform on a slider, lifted by a motor or a spring, with a load of up to 20 times its weight.
void fill_load_lift(SceneMaker& m) {
  m.ground();
  const int foot = m.anchor({0, 8, 0});
  const int platform = m.box({1, 0.1, 1}, {0, 8, 0}, 500);
  const double own = mass_of(m.body(platform)), ratio = m.random.log_between(0.1, 20);
  const int loads = m.count(1, 5);
  double top = 8.1;
  for (int i = 0; i < loads; ++i) {
    const double half = m.random.between(0.1, 0.3);
    const int load = m.box({m.random.between(0.2, 0.4), half, 0.3}, {0, top + half, 0});
    m.set_mass(load, own * ratio / loads);
    top += 2 * half;
  }
  GeneralJoint& lift = m.join(Link::slider, foot, platform, {0, 8, 0}, {0, 1, 0});
  lift.speed = m.random.between(0.1, 1);
  lift.effort = 9.81 * own * (1 + ratio) * m.random.log_between(1.2, 20);
  m.set_friction(m.random.between(0.2, 0.9));
  m.scene.passive = false;
  m.judge(Judge::fastest, 10, 6);
}

// A kinematic plate squeezes a stack to a part of its height, stops, and rises again.
void fill_squeeze(SceneMaker& m) {
  const int count = m.count(1, 8);
  const double half = m.random.between(0.15, 0.3), speed = m.random.between(0.1, 1);
  m.ground();
  for (int i = 0; i < count; ++i) {
    const Triple at{0, half * (2 * i + 1), 0};
    const int kind = m.random.count(0, 2);
    if (kind == 0) m.box({half, half, half}, at);
    if (kind == 1) m.hull(prism(8, half, half), at);
    if (kind == 2) m.ball(half, at);
  }
  const double top = 2 * half * count, squeezed = m.random.between(0.05, 0.6) * top;
  const int plate = m.box({2, 0.3, 2}, {0, top + 0.5, 0});
  m.body(plate).motion = Motion::kinematic;
  m.body(plate).velocity = {0, -speed, 0};
  const int stop = static_cast<int>(60 * (0.2 + squeezed) / speed);
  m.scene.moves = {
      {stop, plate, {}, {}}, {stop + 120, plate, {0, speed, 0}, {}}, {stop + 240, plate, {}, {}}};
  m.set_friction(m.random.between(0.2, 0.9));
  m.scene.passive = false;
  m.judge(Judge::fastest, 20, (stop + 360) / 60.0);
}

}  // namespace

void add_handling_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"topple", "one turning body lands on an end", fill_topple},
              {"wagon", "driven wheels, boards and a load, over bumps", fill_wagon},
              {"load-lift", "a motor lifts up to 20 times a platform's weight", fill_load_lift},
              {"squeeze", "a kinematic plate squeezes a stack and stops", fill_squeeze}});
}

}  // namespace lockstone::bench
