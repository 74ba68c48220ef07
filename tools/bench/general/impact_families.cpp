// Falls, bounces, crowds: nothing may gain energy or pass through a floor.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

void fill_dropped_weight(SceneMaker& m) {
  const double light = m.random.between(0.2, 0.5), heavy = m.random.between(0.2, 0.8);
  m.ground();
  const int below = m.box({light, light, light}, {0, light, 0}, 200);
  const int above =
      m.box({heavy, heavy, heavy}, {m.random.between(-0.3, 0.3) * light, 2 * light + heavy + 1, 0});
  if (m.random.chance(0.5)) m.turn(above, m.any_turn());
  m.body(above).position[1] += 0.8 * heavy;
  m.set_mass(above, mass_of(m.body(below)) * m.random.log_between(10, 5000));
  m.judge(Judge::gain, 0.05, 5);
}

// A stack of random densities that falls over.
void fill_falling_stack(SceneMaker& m) {
  const int n = m.count(5, 50);
  const double half = m.random.between(0.2, 0.5), spread = m.random.log_between(5, 5000);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const double x = half * m.random.between(-0.5, 0.5);
    const double z = half * m.random.between(-0.5, 0.5);
    m.box({half, half, half}, {x, half * (2 * i + 1), z}, 200 * m.random.log_between(1, spread));
  }
  m.judge(Judge::gain, 0.05, 8);
}

// Boxes, rods and balls that bounce without loss.
void fill_elastic(SceneMaker& m) {
  const int n = m.count(1, 6);
  const int kind = m.random.count(0, 2);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const Triple at{3.0 * i, m.random.between(2, 4), 0};
    const double size = m.random.between(0.1, 0.4);
    int body = 0;
    if (kind == 0) body = m.box({size, size * m.random.between(0.2, 4), size}, at);
    if (kind == 1) body = m.capsule(size, size * m.random.between(0.5, 4), at);
    if (kind == 2) body = m.ball(size, at);
    m.turn(body, m.any_turn());
    m.body(body).angular_velocity = m.jitter(3);
  }
  for (GeneralBody& body : m.scene.bodies)
    body.restitution = 1;
  m.set_friction(m.random.between(0, 0.5));
  m.judge(Judge::gain, 0.05, 10);
}

// Many balls at nearly one place above a floor of boxes.
void fill_crowd(SceneMaker& m) {
  const int n = m.count(20, 300);
  const double r = m.random.between(0.1, 0.3), thick = m.random.between(0.1, 1);
  m.fix(m.box({50, thick, 50}, {0, -thick, 0}));
  for (int i = 0; i < n; ++i)
    m.ball(r, Triple{0, 1 + r, 0} + m.jitter(m.random.between(0.01, 1) * r));
  m.scene.passive = false;  // overlapping bodies are pushed apart
  m.judge(Judge::fallen, 0.01, 5);
}

// Small fast bodies against thin walls.
void fill_bullets(SceneMaker& m) {
  const int n = m.count(1, 20);
  const double thick = m.random.log_between(0.002, 0.1);
  m.ground();
  m.fix(m.box({450, thick, 450}, {0, 3, 0}));
  for (int i = 0; i < n; ++i) {
    const Triple at{2.0 * (i % 5 - 2), 8, 2.0 * (i / 5 - 2)};
    const double r = m.random.between(0.03, 0.2);
    const int body = m.random.chance(0.5) ? m.ball(r, at) : m.box({r, r, 0.5 * r}, at);
    m.turn(body, m.any_turn());
    m.body(body).velocity = {0, -m.random.log_between(10, 300), 0};
    m.body(body).angular_velocity = m.jitter(20);
  }
  for (GeneralBody& body : m.scene.bodies)  // so that the wall is where the floor is
    body.position[1] -= 3;
  m.scene.bodies.erase(m.scene.bodies.begin());
  m.scene.low = -3;
  m.judge(Judge::fallen, 0.05, 3);
}

// Plates and rods dropped flat, on edges and corners.
void fill_clatter(SceneMaker& m) {
  const int n = m.count(1, 12);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const double size = m.random.between(0.2, 0.5);
    const Triple at{1.5 * (i % 4), 1.5 + 1.2 * (i / 4), 0};
    const int body = m.random.chance(0.5)
                         ? m.box({size, m.random.log_between(0.005, 0.1), size}, at)
                         : m.box({0.05, size, 0.05}, at);
    m.turn(body, m.any_turn());
    m.body(body).restitution = m.random.between(0, 0.9);
  }
  m.judge(Judge::gain, 0.05, 6);
}

// Plates, rods and boxes thrown at a floor, one after the other.
void fill_wreck(SceneMaker& m) {
  const int n = m.count(2, 150);
  const double size = m.random.between(0.2, 0.6), thick = size / m.random.log_between(2, 50);
  const double speed = m.random.log_between(2, 60), rods = m.random.between(0, 0.5);
  m.ground();
  for (int i = 0; i < n; ++i) {
    const double wide = size * m.random.between(0.5, 1), deep = size * m.random.between(0.5, 1);
    const double pitch = 2.1 * size;
    const Triple at = {pitch * (i % 2) + 0.2 * size * m.random.between(-1, 1),
                       pitch * (1 + static_cast<double>(i / 4)), pitch * (i / 2 % 2)};
    const int body =
        m.random.chance(rods) ? m.box({wide, thick, thick}, at) : m.box({wide, thick, deep}, at);
    m.turn(body, m.any_turn());
    m.body(body).velocity = Triple{0, -speed, 0} + m.jitter(0.1 * speed);
    m.body(body).angular_velocity = m.jitter(m.random.between(0, 0.5) * speed);
  }
  m.set_friction(m.random.between(0.1, 0.9));
  m.judge(Judge::gain, 0.05, 6);
}

// A heavy box falls on a pile of light boxes and balls.
void fill_crush(SceneMaker& m) {
  const int n = m.count(4, 150), side = m.random.count(2, 4);
  const double size = m.random.between(0.1, 0.3), balls = m.random.between(0, 0.5);
  m.fix(m.box({450, 1, 450}, {0, -1, 0}));  // the fastest stay on it
  for (int i = 0; i < n; ++i) {
    const double half = size * m.random.between(0.6, 1);
    const int layer = i / (side * side), cell = i % (side * side);
    const Triple at =
        Triple{2.1 * size * (cell % side - 0.5 * (side - 1)), 2.1 * size * (layer + 0.6),
               2.1 * size * (cell / side - 0.5 * (side - 1))} +
        m.jitter(0.1 * size);
    const int light =
        m.random.chance(balls) ? m.ball(half, at, 500) : m.box({half, half, half}, at, 500);
    m.watch(light);
  }
  const double big = size * side * m.random.between(0.7, 1.2);
  const double top = 2.1 * size * (1 + static_cast<double>((n - 1) / (side * side)));
  const int heavy = m.box({big, big, big}, {0, top + big + 1, 0});
  m.turn(heavy, m.random.chance(0.5) ? m.any_turn() : Turn{});
  m.body(heavy).position[1] += big;
  m.set_mass(heavy, 500 * 8 * size * size * size * m.random.log_between(1, 100'000));
  m.set_friction(m.random.between(0.3, 0.9));
  m.scene.may_sleep = true;
  m.judge(Judge::sunk, 0.02, 6);
}

}  // namespace

void add_impact_families(std::vector<Family>& all) {
  all.insert(
      all.end(),
      {{"dropped-weight", "box dropped 1 m on a light one, 10-5000 : 1", fill_dropped_weight},
       {"falling-stack", "5-50 boxes, densities up to 5000 : 1", fill_falling_stack},
       {"elastic", "boxes, capsules or balls that bounce, e = 1", fill_elastic},
       {"clatter", "plates and rods dropped any way", fill_clatter},
       {"crowd", "20-300 balls at one place: none falls through", fill_crowd},
       {"crush", "heavy box dropped on 4-150 light bodies, up to 100,000 : 1", fill_crush},
       {"wreck", "2-150 plates and rods thrown down at 2-60 m/s", fill_wreck},
       {"bullets", "small fast bodies against a wall of 4-200 mm", fill_bullets}});
}

}  // namespace lockstone::bench
