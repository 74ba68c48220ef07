// Motors and springs in linkages.
#include <cmath>
#include <vector>

#include "tools/bench/general/maker.h"
#include "tools/bench/general/vectors.h"

namespace lockstone::bench {
namespace {

using namespace general;

void free_of_contacts(SceneMaker& m) {
  for (GeneralBody& body : m.scene.bodies)
    body.collides = false;
  m.scene.passive = false;
}

// A crank, a rod and a slider, turned by a motor of ample torque.
void fill_slider_crank(SceneMaker& m) {
  const double arm = m.random.between(0.1, 0.4), rod = arm * m.random.between(2.2, 5);
  const double speed = m.random.between(1, 8);
  const int crank = m.box({0.5 * arm, 0.03, 0.03}, {0.5 * arm, 0, 0});
  const int bar = m.box({0.5 * rod, 0.03, 0.03}, {arm + 0.5 * rod, 0, 0});
  const int slide = m.box({0.1, 0.1, 0.1}, {arm + rod, 0, 0}, m.random.log_between(500, 5000));
  const int frame = m.anchor({0, 0, 0});
  GeneralJoint& motor = m.join(Link::hinge, frame, crank, {0, 0, 0});
  motor.speed = speed;
  motor.effort = 5000;
  m.join(Link::hinge, crank, bar, {arm, 0, 0});
  m.join(Link::hinge, bar, slide, {arm + rod, 0, 0});
  m.join(Link::slider, frame, slide, {arm + rod, 0, 0}, {1, 0, 0});
  free_of_contacts(m);
  m.judge(Judge::rate, 0.01, 8);
}

// A loaded arm on a hinge that a motor turns.
void fill_motor_arm(SceneMaker& m) {
  const double length = m.random.between(0.3, 2);
  const int arm = m.box({length, 0.05, 0.05}, {length, 0, 0});
  const int load = m.box({0.1, 0.1, 0.1}, {2 * length, 0, 0}, m.random.log_between(200, 2e4));
  GeneralJoint& motor = m.join(Link::hinge, m.anchor({0, 0, 0}), arm, {0, 0, 0});
  motor.speed = m.random.between(0.5, 6);
  motor.effort = 1e5;
  m.join(m.random.chance(0.5) ? Link::weld : Link::hinge, arm, load, {2 * length, 0, 0});
  free_of_contacts(m);
  m.judge(Judge::rate, 0.01, 6);
}

// A spring turns a hinge to any angle.
void fill_hinge_spring(SceneMaker& m) {
  const int a = m.anchor({0, 0, 0});
  const int b = m.box({m.random.between(0.1, 0.5), 0.1, 0.2}, {0, 0, 0}, 1000);
  GeneralJoint& spring = m.join(Link::hinge, a, b, {0, 0, 0}, m.direction());
  spring.target = m.random.between(-3, 3);
  spring.hertz = m.random.log_between(0.5, 8);
  spring.damping = m.random.between(0.5, 1.5);
  free_of_contacts(m);
  m.judge(Judge::angle, 0.02, 10);
}

// A spring about all axes turns a body from anywhere to anywhere, against the world or against a
// body that is free. Some begin with a spin, but no free pair: it would keep its angular momentum.
void fill_turn_spring(SceneMaker& m) {
  const double r = m.random.log_between(0.1, 0.4);
  const auto side = [&] { return r * m.random.log_between(0.6, 1); };
  const bool held = m.random.chance(0.5);
  const int a = held ? m.anchor({0, 0, 0}) : m.box({side(), side(), side()}, {0, 0, 0});
  const int form = m.random.count(0, 2);
  const int b = form == 0   ? m.ball(r, {0, 0, 0})
                : form == 1 ? m.capsule(0.5 * r, side(), {0, 0, 0})
                            : m.box({side(), side(), side()}, {0, 0, 0});
  const Triple at = m.random.chance(0.5) ? Triple{} : m.jitter(0.1 * r);
  GeneralJoint& spring = m.join(Link::ball, a, b, at, m.direction());
  const Triple axis = m.direction();
  spring.turn = m.random.between(0, std::acos(-1.0)) * axis;
  spring.hertz = m.random.log_between(2, 8);
  spring.damping = m.random.between(0.5, 1.5);
  const Turn frame = m.any_turn();
  m.turn(b, frame);
  m.body(b).position = at - turned(frame, spring.anchor_b);
  if (held && m.random.chance(0.7))
    m.body(b).angular_velocity = m.random.between(0, 20) * m.direction();
  free_of_contacts(m);
  m.scene.gravity = 0;
  m.judge(Judge::turn, 0.02, 10);
}

// A body on an undamped spring: the amplitude that remains after ten seconds.
void fill_spring(SceneMaker& m) {
  const double hertz = m.random.log_between(0.3, 10), rest = m.random.between(1, 2);
  const double pulled = m.random.between(0.05, 0.3);
  const int a = m.anchor({0, 0, 0});
  const int b = m.ball(m.random.between(0.1, 0.4), {rest + pulled, 0, 0});
  GeneralJoint& spring = m.rod(a, b, {0, 0, 0}, m.body(b).position);
  spring.target = rest;
  spring.hertz = hertz;
  free_of_contacts(m);
  m.scene.gravity = 0;
  m.scene.expected = pulled;
  m.judge(Judge::amplitude, 0.01, 10);
}

// A wheel that a motor turns, which turns others by rods: coupled cranks.
void fill_coupled_wheels(SceneMaker& m) {
  const int n = m.count(2, 5);
  const double r = m.random.between(0.2, 0.5), pitch = 2.2 * r;
  std::vector<int> wheels;
  for (int i = 0; i < n; ++i) {
    const int wheel = m.box({r, r, 0.05}, {i * pitch, 0, 0}, m.random.log_between(200, 2000));
    GeneralJoint& axle = m.join(Link::hinge, m.anchor({i * pitch, 0, 0}), wheel, {i * pitch, 0, 0});
    if (i == 0) {
      axle.speed = m.random.between(1, 6);
      axle.effort = 1e5;
    }
    wheels.push_back(wheel);
  }
  // A rod that all cranks share, and one a quarter turn on: the toggle of one is not the other's.
  for (const Triple& pin : {Triple{0.8 * r, 0, 0.1}, Triple{0, 0.8 * r, -0.1}}) {
    const double half = 0.5 * (n - 1) * pitch;
    const int bar = m.box({half + 0.05, 0.04, 0.04}, pin + Triple{half, 0, 0});
    for (int i = 0; i < n; ++i)
      m.join(Link::hinge, wheels[static_cast<std::size_t>(i)], bar, pin + Triple{i * pitch, 0, 0});
  }
  free_of_contacts(m);
  m.judge(Judge::rate, 0.01, 6);
}

}  // namespace

void add_drive_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"slider-crank", "a motor turns a crank, 1-8 rad/s", fill_slider_crank},
              {"motor-arm", "a motor turns a loaded arm", fill_motor_arm},
              {"coupled-wheels", "a motor turns 2-5 wheels by two rods", fill_coupled_wheels},
              {"hinge-spring", "a spring turns a hinge to within 3 rad", fill_hinge_spring},
              {"turn-spring", "a spring turns a ball joint from any pose to any", fill_turn_spring},
              {"spring", "undamped, 0.3-10 Hz: amplitude lost in 10 s", fill_spring}});
}

}  // namespace lockstone::bench
