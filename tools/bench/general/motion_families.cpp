// Bodies that others move, and bodies that move over others.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

void kinematic(SceneMaker& m, int body, const Triple& velocity, const Triple& spin = {0, 0, 0}) {
  m.body(body).motion = Motion::kinematic;
  m.body(body).velocity = velocity;
  m.body(body).angular_velocity = spin;
  m.scene.passive = false;
}

// A thin paddle turns and must strike the body in its path.
void fill_turning_paddle(SceneMaker& m) {
  const double length = m.random.between(1, 2), spin = m.random.between(5, 40);
  const int paddle = m.box({length, 0.3, m.random.log_between(0.0025, 0.02)}, {0, 0, 0});
  kinematic(m, paddle, {0, 0, 0}, {0, spin, 0});
  const int n = m.count(1, 8);
  for (int i = 0; i < n; ++i) {
    const double angle = 0.35 + 2.4 * i / n, r = length * m.random.between(0.5, 0.9);
    const double size = m.random.between(0.02, 0.08);
    const Triple at{r * std::cos(angle), 0, -r * std::sin(angle)};
    const int body = m.random.chance(0.5) ? m.capsule(size, 2 * size, at) : m.ball(size, at);
    m.watch(body);
  }
  m.scene.gravity = 0;
  m.scene.expected = 0.2;
  m.judge(Judge::missed, 0, 1);
}

void fill_fast_paddle(SceneMaker& m) {
  const double speed = m.random.log_between(10, 200), r = m.random.between(0.05, 0.2);
  const double begin = m.random.between(3, 8);
  const int paddle = m.box({m.random.log_between(0.01, 0.1), 1, 1}, {-begin, 0, 0});
  kinematic(m, paddle, {speed, 0, 0});
  m.watch(m.ball(r, {0, 0, 0}));
  m.scene.gravity = 0;
  m.scene.expected = 0.5;
  m.judge(Judge::missed, 0, 1);
}

// A ball flies through a trigger, which must see it.
void fill_trigger(SceneMaker& m) {
  const double speed = m.random.log_between(5, 300), thick = m.random.between(0.01, 0.2);
  const int gate = m.box({thick, 1, 1}, {m.random.between(3, 8), 0, 0});
  m.fix(gate);
  m.body(gate).trigger = true;
  const int ball = m.ball(m.random.between(0.03, 0.2), {0, 0, 0});
  m.body(ball).velocity = {speed, 0, 0};
  m.watch(ball);
  m.scene.gravity = 0;
  m.judge(Judge::entered, 0, 3);
}

void tiles(SceneMaker& m, double way) {
  const double half = m.random.between(0.25, 1);
  for (int i = -2; 2 * half * i < way; ++i)
    m.fix(m.box({half, 0.5, 3}, {2 * half * i, -0.5, 0}));
}

// A ball rolls over static boxes side by side.
void fill_tiles_roll(SceneMaker& m) {
  const double speed = m.random.between(2, 20), r = m.random.between(0.1, 0.5);
  tiles(m, 3 * speed + 2);
  const int ball = m.ball(r, {0, r, 0});
  m.body(ball).velocity = {speed, 0, 0};
  m.body(ball).angular_velocity = {0, 0, -speed / r};
  m.scene.low = -1;
  m.judge(Judge::bounce, 0.001, 2);
}

// A box slides over them without friction.
void fill_tiles_slide(SceneMaker& m) {
  const double speed = m.random.between(1, 10), half = m.random.between(0.1, 0.5);
  tiles(m, 3 * speed + 2);
  const int box = m.box({half, half, half}, {0, half, 0});
  m.body(box).velocity = {speed, 0, 0};
  m.set_friction(0);
  m.scene.low = -1;
  m.judge(Judge::slowed, 0.01, 2);
}

// Boxes or hulls in rows and columns, turned about y, up to 10 µm apart and 10 µm higher or lower
// than y = 0, under a way along x.
void tile_grid(SceneMaker& m, double way, double width) {
  const double turn = m.random.between(-3, 3), c = std::cos(turn), s = std::sin(turn);
  const double x = m.random.between(0.2, 1), z = m.random.between(0.2, 1);
  const double gap = m.random.between(0, 1e-5), rough = m.random.between(0, 1e-5);
  const bool hulls = m.random.chance(0.5);
  std::vector<Triple> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i % 2 == 0 ? -x : x, i % 4 < 2 ? -0.5 : 0.5, i < 4 ? -z : z});
  const int n = static_cast<int>((way + 4) / std::min(x, z));
  for (int i = -n; i <= n; ++i) {
    for (int k = -n; k <= n; ++k) {
      const double u = i * (2 * x + gap), v = k * (2 * z + gap);
      const Triple at{c * u + s * v, -0.5 + m.random.between(-rough, rough), c * v - s * u};
      const double reach = x + z;
      if (at[0] < -2 - reach || at[0] > way + reach || std::abs(at[2]) > width + reach) continue;
      const int tile = hulls ? m.hull(corners, at) : m.box({x, 0.5, z}, at);
      m.fix(tile);
      m.turn(tile, {0, std::sin(turn / 2), 0, std::cos(turn / 2)});
    }
  }
}

// A ball or a capsule rolls over them.
void fill_grid_roll(SceneMaker& m) {
  const double speed = m.random.between(2, 20), r = m.random.between(0.05, 0.5);
  tile_grid(m, 2 * speed + 2, 3 * r);
  const bool ball = m.random.chance(0.5);
  const int body = ball ? m.ball(r, {0, r, 0}) : m.capsule(r, r, {0, r, 0});
  m.turn(body, {std::sqrt(0.5), 0, 0, std::sqrt(0.5)});
  m.body(body).velocity = {speed, 0, 0};
  m.body(body).angular_velocity = {0, 0, -speed / r};
  m.scene.low = -1;
  m.judge(Judge::bounce, 0.001, 2);
}

// A box, a brick as a hull, or a ball slides over them without friction.
void fill_grid_slide(SceneMaker& m) {
  const double speed = m.random.between(1, 15), x = m.random.between(0.05, 0.5);
  const double y = x * m.random.between(0.3, 1), z = x * m.random.between(0.3, 1);
  tile_grid(m, 2 * speed + 2, 2 * x);
  std::vector<Triple> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i % 2 == 0 ? -x : x, i % 4 < 2 ? -y : y, i < 4 ? -z : z});
  const int kind = m.random.count(0, 2);
  const int body = kind == 0   ? m.box({x, y, z}, {0, y, 0})
                   : kind == 1 ? m.hull(corners, {0, y, 0})
                               : m.ball(y, {0, y, 0});
  m.body(body).velocity = {speed, 0, 0};
  m.set_friction(0);
  m.scene.low = -1;
  m.judge(Judge::slowed, 0.01, 2);
}

// Crates ride on a platform that speeds up gently, stops, and goes up and down.
void fill_platform(SceneMaker& m) {
  const int platform = m.box({3, 0.2, 3}, {0, -0.2, 0});
  const double speed = m.random.between(0.2, 2), friction = m.random.between(0.4, 0.8);
  const int ramp = static_cast<int>(60 * 2 * speed / (9.81 * friction)) + 2;
  kinematic(m, platform, {0, 0, 0});
  const int n = m.count(1, 9), high = m.count(1, 3);
  for (int i = 0; i < n * high; ++i)
    m.box({0.3, 0.3, 0.3}, {1.2 * (i % n % 3 - 1), 0.3 + 0.6 * (i / n), 1.2 * (i % n / 3 - 1)});
  const Triple way = m.random.chance(0.5) ? Triple{speed, 0, 0} : Triple{0, 0.3 * speed, 0};
  for (int k = 0; k < 4; ++k) {  // up to speed and to a stop, and the same way back
    const double sign = k < 2 ? 1 : -1;
    for (int i = 1; i <= ramp; ++i) {
      const double share = sign * (k % 2 == 0 ? i : ramp - i) / ramp;
      m.scene.moves.push_back({k * (ramp + 60) + i, platform, share * way, {}});
    }
  }
  m.set_friction(friction);
  m.judge(Judge::displacement, 0.02, (4.0 * (ramp + 60) + 120) / 60);
  m.scene.expected = 1;
}

// A turntable carries the bodies on it.
void fill_turntable(SceneMaker& m) {
  const double friction = m.random.between(0.5, 0.9), radius = 2;
  const double spin = std::sqrt(9.81 * friction / radius) * m.random.between(0.3, 0.7);
  const int n = m.count(1, 12);
  const int table = m.box({3, 0.2, 3}, {0, -0.2, 0});
  kinematic(m, table, {0, 0, 0});
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n, r = radius * m.random.between(0.55, 1);
    m.box({0.15, m.random.between(0.05, 0.2), 0.15},
          {r * std::cos(angle), 0.2, r * std::sin(angle)});
    GeneralBody& crate = m.scene.bodies.back();
    crate.position[1] = crate.size[1];
  }
  // Whole turns: it ends where it began. It starts and stops within a second and a half.
  const int ramp = 90, turns = m.random.count(1, 3);
  const double per_tick = spin / 60;
  const int hold = static_cast<int>(std::ceil(2 * std::numbers::pi * turns / per_tick)) - ramp;
  const double fitted = 60 * 2 * std::numbers::pi * turns / (hold + ramp);
  for (int i = 1; i <= ramp; ++i) {
    m.scene.moves.push_back({i - 1, table, {}, {0, fitted * i / ramp, 0}});
    m.scene.moves.push_back({ramp + hold + i - 1, table, {}, {0, fitted * (ramp - i) / ramp, 0}});
  }
  m.set_friction(friction);
  m.judge(Judge::displacement, 0.02, (2.0 * ramp + hold + 60) / 60);
  m.scene.expected = 1;
}

}  // namespace

void add_motion_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"turning-paddle", "thin paddle, 5-40 rad/s: bodies missed", fill_turning_paddle},
              {"fast-paddle", "kinematic wall of 10-200 m/s: balls missed", fill_fast_paddle},
              {"trigger", "ball of 5-300 m/s through a trigger", fill_trigger},
              {"tiles-roll", "ball over static boxes, 2-20 m/s: kick", fill_tiles_roll},
              {"tiles-slide", "box over them without friction: slowed", fill_tiles_slide},
              {"grid-roll", "ball, capsule over a grid of boxes, hulls: kick", fill_grid_roll},
              {"grid-slide", "box, hull, ball over one without friction: slowed", fill_grid_slide},
              {"platform", "crates on a platform that moves and comes back", fill_platform},
              {"turntable", "crates on a table that makes whole turns", fill_turntable}});
}

}  // namespace lockstone::bench
