// Events in mid run: bodies that appear, vanish or are blown apart, and gravity that turns.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

void wide_ground(SceneMaker& m) {
  m.fix(m.box({450, 1, 450}, {0, -1, 0}));
}

// Bodies of any mass at one place, some of them a second later.
void fill_spawn(SceneMaker& m) {
  const int n = m.count(2, 30);
  const double size = m.random.between(0.1, 0.4), apart = m.random.log_between(0.001, 1) * size;
  const double spread = m.random.log_between(1, 10'000), late = m.random.between(0, 0.5);
  const double high = m.random.chance(0.5) ? size : 2;
  wide_ground(m);
  for (int i = 0; i < n; ++i) {
    const Triple at = Triple{0, high, 0} + m.jitter(apart);
    const int body = any_body(m, size, at, 20 * m.random.log_between(1, spread));
    m.turn(body, m.random.chance(0.5) ? m.any_turn() : Turn{0, 0, 0, 1});
    if (m.random.chance(late)) m.body(body).from = 60;
  }
  m.set_friction(m.random.between(0.2, 0.9));
  m.scene.passive = false;  // overlapping bodies are pushed apart
  m.judge(Judge::fastest, 25, 5);
}

// A pile that has settled is blown apart from its middle.
void fill_blast(SceneMaker& m) {
  const int n = m.count(5, 120), side = m.random.count(2, 4);
  const double size = m.random.between(0.1, 0.3), spread = m.random.log_between(1, 1000);
  const double fastest = m.random.log_between(3, 60), pitch = 2.1 * size;
  const Triple middle{0, m.random.between(0, 1) * pitch * (n / (side * side) + 1), 0};
  wide_ground(m);
  for (int i = 0; i < n; ++i) {
    const Triple at = cell(i, side, pitch) + m.jitter(0.05 * size);
    const double density = 100 * m.random.log_between(1, spread);
    const int body = any_body(m, 0.9 * size, at, density);
    m.turn(body, m.any_turn());
    const Triple out = at - middle;
    const double far = norm(out) / pitch + 0.5;
    const double speed = fastest * std::min(1.0, 100 / density * spread / (far * far));
    if (speed < 0.5) continue;
    const Triple way = (speed / (norm(out) + 1e-3)) * out;
    m.scene.moves.push_back({90, body, way, m.jitter(speed)});
  }
  m.set_friction(m.random.between(0.2, 0.9));
  m.judge(Judge::gain, 0.05, 5);
}

void hung_rope(SceneMaker& m) {
  const int n = m.count(4, 30);
  const double half = 0.12, y = 2 * half * n + m.random.between(0.5, 2);
  int before = m.anchor({0, y, 0});
  const int cut = m.random.count(0, n - 1);
  for (int i = 0; i < n; ++i) {
    const int link = m.capsule(0.04, half - 0.04, {0, y - (2 * i + 1) * half, 0}, 800);
    m.join(Link::ball, before, link, {0, y - 2 * i * half, 0});
    if (i == cut) m.body(link).until = 90;
    before = link;
  }
  const int load = m.box({0.2, 0.2, 0.2}, {0, y - 2 * n * half - 0.2, 0});
  m.set_mass(load, mass_of(m.body(before)) * m.random.log_between(1, 1000));
  m.join(Link::ball, before, load, {0, y - 2 * n * half, 0});
  m.body(load).velocity = {m.random.between(0, 2), 0, m.random.between(0, 2)};
}

void loaded_bridge(SceneMaker& m) {
  const int n = m.count(3, 20), loads = m.count(1, 8);
  const double pitch = m.random.between(0.3, 0.6), y = m.random.between(0.5, 0.5 * n * pitch);
  int before = m.anchor({0, y, 0});
  for (int i = 0; i < n; ++i) {
    const int plank = m.box({0.47 * pitch, 0.04, 0.5}, {(i + 0.5) * pitch, y, 0}, 600);
    m.join(Link::hinge, before, plank, {i * pitch, y, 0});
    before = plank;
  }
  const int end = m.anchor({n * pitch, y, 0});
  m.join(Link::hinge, before, end, {n * pitch, y, 0});
  m.body(end).until = 60;
  for (int i = 0; i < loads; ++i)
    m.box({0.15, 0.15, 0.15}, {n * pitch * (i + 1) / (loads + 1), y + 0.2, 0},
          m.random.log_between(100, 8000));
}

void hung_platform(SceneMaker& m) {
  const int loads = m.count(1, 9), high = m.count(1, 4);
  const double y = m.random.between(0.5, 3);
  const int platform = m.box({1, 0.06, 1}, {0, y, 0}, 600);
  for (const double x : {-0.9, 0.9}) {
    for (const double z : {-0.9, 0.9}) {
      const Triple top{x * 1.2, y + 2, z * 1.2}, low{x, y + 0.06, z};
      const int post = m.anchor(top);
      m.rod(post, platform, top, low);
      if (m.random.chance(0.6)) m.body(post).until = 60 + m.random.count(0, 60);
    }
  }
  for (int i = 0; i < loads * high; ++i)
    m.box({0.15, 0.15, 0.15},
          {0.5 * (i % loads % 3 - 1), y + 0.21 + 0.3 * (i / loads), 0.5 * (i % loads / 3 - 1)},
          m.random.log_between(100, 8000));
}

// A support of a load vanishes: a link of its rope, an end of its bridge, ropes of its platform.
void fill_cut(SceneMaker& m) {
  m.ground();
  const int kind = m.random.count(0, 2);
  if (kind == 0) hung_rope(m);
  if (kind == 1) loaded_bridge(m);
  if (kind == 2) hung_platform(m);
  m.set_friction(m.random.between(0.3, 0.8));
  m.judge(Judge::gap, 0.02, 5);
}

// A pile upon four doors that vanish one after the other.
void fill_trapdoor(SceneMaker& m) {
  const int n = m.count(4, 120), side = m.random.count(2, 4);
  const double size = m.random.between(0.1, 0.3), spread = m.random.log_between(1, 1000);
  const double half = 1.15 * size * side + 0.1, high = m.random.between(0.5, 3);
  m.ground();
  pen(m, half, 6 + high);
  for (const double x : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0}) {
      const int door = m.box({half / 2, 0.1, half / 2}, {x * half / 2, high, z * half / 2});
      m.fix(door);
      m.body(door).until = 90 + m.random.count(0, 60);
    }
  }
  for (int i = 0; i < n; ++i) {
    const Triple at = cell(i, side, 2.2 * size) + Triple{0, high + 0.1, 0} + m.jitter(0.05 * size);
    const int body = any_body(m, size, at, 100 * m.random.log_between(1, spread));
    m.turn(body, m.any_turn());
  }
  m.set_friction(m.random.between(0.3, 0.9));
  heap(m, 15);
}

// Bodies in a closed room whose gravity turns three times.
void fill_gravity_turn(SceneMaker& m) {
  const int n = m.count(2, 120), side = m.random.count(2, 4);
  const double size = m.random.between(0.1, 0.3), spread = m.random.log_between(1, 100);
  const double half = 1.1 * size * std::max(1.0 * side, 1.0 + n / (side * side)) + 0.3;
  m.scene.low = -half;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double way : {-1.0, 1.0}) {
      Triple wall{half + 1, half + 1, half + 1}, at{};
      wall[axis] = 0.5;
      at[axis] = way * (half + 0.5);
      m.fix(m.box(wall, at));
    }
  }
  for (int i = 0; i < n; ++i) {
    const Triple at = cell(i, side, 2.1 * size) - Triple{0, half - 0.1 * size, 0};
    const int body = any_body(m, size, at, 200 * m.random.log_between(1, spread));
    if (m.random.chance(0.5)) m.turn(body, m.any_turn());
    m.watch(body);
  }
  for (int i = 1; i <= 3; ++i) {
    Triple gravity{};
    gravity[static_cast<std::size_t>(m.random.count(0, 2))] = m.random.chance(0.5) ? 9.81 : -9.81;
    m.scene.pulls.push_back({120 * i, gravity});
  }
  m.set_friction(m.random.between(0.2, 0.9));
  m.scene.expected = half;
  m.judge(Judge::outside, 0, 8);
}

}  // namespace

void add_event_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"spawn", "2-30 bodies at one place, up to 10,000 : 1: fastest", fill_spawn},
              {"blast", "5-120 bodies of a pile, blown apart: energy", fill_blast},
              {"cut", "a link, an end or ropes under load vanish", fill_cut},
              {"trapdoor", "4-120 bodies on doors that vanish", fill_trapdoor},
              {"gravity-turn", "2-120 bodies in a room whose gravity turns: none leaves",
               fill_gravity_turn}});
}

}  // namespace lockstone::bench
