// Bodies that are jointed and touch: bridges, cranes, carts, doors.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

// Planks on hinges between two posts, and boxes upon them.
void fill_bridge(SceneMaker& m) {
  const int n = m.count(4, 40), loads = m.count(0, 8);
  const double pitch = m.random.between(0.3, 0.6), y = 0.3 * n * pitch + 1;
  m.ground();
  int before = m.anchor({0, y, 0});
  for (int i = 0; i < n; ++i) {
    const int plank = m.box({0.47 * pitch, 0.04, 0.5}, {(i + 0.5) * pitch, y, 0}, 600);
    m.join(Link::hinge, before, plank, {i * pitch, y, 0});
    before = plank;
  }
  m.join(Link::hinge, before, m.anchor({n * pitch, y, 0}), {n * pitch, y, 0});
  for (int i = 0; i < loads; ++i)
    m.box({0.15, 0.15, 0.15}, {n * pitch * (i + 1) / (loads + 1), y + 0.25, 0},
          m.random.log_between(100, 5000));
  m.set_friction(0.7);
  m.judge(Judge::gap, 0.02, 10);
}

// A deck hung by ropes of balls from two towers.
void fill_suspension(SceneMaker& m) {
  const int n = m.count(4, 14);
  const double pitch = 0.6, y = 3;
  std::vector<int> deck;
  for (int i = 0; i < n; ++i) {
    deck.push_back(m.box({0.28, 0.05, 0.5}, {i * pitch, y, 0}, 500));
    for (const double side : {-0.5, 0.5}) {
      const Triple low{i * pitch, y, side}, high{i * pitch, y + m.random.between(0.8, 1.6), side};
      m.rod(m.anchor(high), deck.back(), high, low);
    }
    if (i > 0)
      m.join(Link::hinge, deck[static_cast<std::size_t>(i - 1)], deck.back(),
             {(i - 0.5) * pitch, y, 0});
  }
  const int loads = m.count(0, 5);
  for (int i = 0; i < loads; ++i)
    m.box({0.15, 0.15, 0.15}, {pitch * (i + 0.5), y + 0.2, 0}, m.random.log_between(200, 5000));
  m.judge(Judge::gap, 0.01, 10);
}

// A rope of capsules with a load that touches a post on its way.
void fill_rope(SceneMaker& m) {
  const int n = m.count(4, 40);
  const double half = m.random.between(0.06, 0.15), y = 2 * half * n + 1;
  m.ground();
  m.fix(m.capsule(0.2, 3, {m.random.between(0.3, 0.7) * n * half, y - half * n, 0}));
  m.turn(1, turn_about({1, 0, 0}, std::numbers::pi / 2));
  int before = m.anchor({0, y, 0});
  for (int i = 0; i < n; ++i) {
    const int link = m.capsule(0.4 * half, 0.6 * half, {(2 * i + 1) * half, y, 0});
    m.turn(link, turn_about({0, 0, 1}, std::numbers::pi / 2));
    m.join(Link::ball, before, link, {2 * i * half, y, 0});
    before = link;
  }
  const double mass = mass_of(m.body(before)) * m.random.log_between(1, 300);
  const int load = m.ball(0.2, {2 * n * half, y, 0});
  m.set_mass(load, mass);
  m.join(Link::ball, before, load, {2 * n * half, y, 0});
  m.judge(Judge::gap, 0.02, 8);
}

// A boom on a mast, held by a cable, with a load on a rope.
void fill_crane(SceneMaker& m) {
  const double boom = m.random.between(1, 3), mast = boom * m.random.between(0.6, 1.2);
  const double tilt = m.random.between(0, 0.6), y = 3;
  const Triple foot{0, y, 0}, along{std::cos(tilt), std::sin(tilt), 0};
  const int post = m.anchor(foot);
  const int arm = m.box({boom, 0.08, 0.08}, foot + boom * along, 800);
  m.turn(arm, turn_about({0, 0, 1}, tilt));
  m.join(Link::hinge, post, arm, foot);
  const Triple tip = foot + 1.95 * boom * along, top{0, y + 1.5 * mast, 0};
  m.rod(m.anchor(top), arm, top, tip);
  const int links = m.count(1, 12);
  const double half = 0.08;
  int before = arm;
  for (int i = 0; i < links; ++i) {
    const int link = m.capsule(0.03, half - 0.03, tip - Triple{0, (2 * i + 1) * half, 0});
    m.join(Link::ball, before, link, tip - Triple{0, 2 * i * half, 0});
    before = link;
  }
  const Triple hook = tip - Triple{0, 2 * links * half, 0};
  const int load = m.box({0.3, 0.3, 0.3}, hook - Triple{0, 0.3, 0}, m.random.log_between(50, 5000));
  m.join(Link::ball, before, load, hook);
  m.body(load).velocity = {0, 0, m.random.between(0, 1)};
  for (GeneralBody& body : m.scene.bodies)
    body.collides = false;
  m.judge(Judge::gap, 0.01, 10);
}

// Crossed pairs of bars on a slider, with a load on top: stands by one locked foot.
void fill_scissor(SceneMaker& m) {
  const int stages = m.count(1, 6);
  const double half = 0.5, angle = m.random.between(0.4, 1.1);
  const double wide = half * std::cos(angle), high = 2 * half * std::sin(angle);
  const int frame = m.anchor({0, 0, 0});
  int left = frame, right = -1;
  double y = 0;
  for (int i = 0; i < stages; ++i, y += high) {
    const int rise = m.box({half, 0.03, 0.03}, {0, y + 0.5 * high, 0});
    m.turn(rise, turn_about({0, 0, 1}, angle));
    const int fall = m.box({half, 0.03, 0.03}, {0, y + 0.5 * high, 0.1});
    m.turn(fall, turn_about({0, 0, 1}, -angle));
    m.join(Link::hinge, rise, fall, {0, y + 0.5 * high, 0.05});
    m.join(Link::hinge, left, rise, {-wide, y, 0});
    if (right >= 0)
      m.join(Link::hinge, right, fall, {wide, y, 0});
    else
      m.join(Link::hinge, frame, fall, {wide, y, 0});
    left = fall;
    right = rise;
  }
  const int load = m.box({wide, 0.1, 0.3}, {0, y + 0.1, 0}, m.random.log_between(100, 5000));
  m.join(Link::hinge, left, load, {-wide, y, 0});
  m.join(Link::hinge, right, load, {wide, y, 0});  // redundant: it is held already
  for (GeneralBody& body : m.scene.bodies)
    body.collides = false;
  m.judge(Judge::displacement, 0.01, 8);
}

// A plank on an edge that rocks under falling weights.
void fill_seesaw(SceneMaker& m) {
  const double half = m.random.between(1, 2.5), high = m.random.between(0.3, 0.8);
  m.ground();
  const int post = m.anchor({0, high, 0});
  const int plank = m.box({half, 0.05, 0.3}, {0, high, 0}, 600);
  m.join(Link::hinge, post, plank, {0, high, 0});
  const int n = m.count(1, 6);
  for (int i = 0; i < n; ++i) {
    const double x = half * m.random.between(-0.9, 0.9);
    m.box({0.15, 0.15, 0.15}, {x, high + 0.4 + 0.35 * i, 0}, m.random.log_between(100, 20000));
  }
  m.set_friction(0.7);
  m.judge(Judge::gap, 0.01, 8);
}

// A plank that two chains hold level, and loads upon it.
void fill_drawbridge(SceneMaker& m) {
  const double length = m.random.between(1, 2.5), y = 3;
  const int deck = m.box({length, 0.08, 0.6}, {length, y, 0}, 700);
  m.join(Link::hinge, m.anchor({0, y, 0}), deck, {0, y, 0});
  const int links = m.count(3, 16);
  for (const double side : {-0.6, 0.6}) {
    const Triple from{0, y + 1.2 * length, side}, to{1.9 * length, y, side};
    const Triple step = (1.0 / links) * (to - from);
    const Turn turn = turn_from_x((1 / norm(step)) * step);
    int before = m.anchor(from);
    for (int i = 0; i < links; ++i) {
      const int link = m.box({0.5 * norm(step), 0.03, 0.03}, from + (i + 0.5) * step);
      m.turn(link, turn);
      m.body(link).collides = false;
      m.join(Link::ball, before, link, from + static_cast<double>(i) * step);
      before = link;
    }
    m.join(Link::ball, before, deck, to);
  }
  const int loads = m.count(0, 4);
  for (int i = 0; i < loads; ++i)
    m.box({0.2, 0.2, 0.2}, {0.4 + 0.42 * i, y + 0.29, 0}, m.random.log_between(100, 4000));
  m.judge(Judge::gap, 0.01, 8);
}

// A cart of four wheels rolls into a rut and comes to rest there.
void fill_cart(SceneMaker& m) {
  const double r = m.random.between(0.2, 0.4), depth = r * m.random.between(0.3, 1);
  m.fix(m.box({4, 1, 3}, {-4 - 1.5 * r, -1, 0}));
  m.fix(m.box({4, 1, 3}, {4 + 1.5 * r, -1, 0}));
  m.fix(m.box({4, 1, 3}, {0, -1 - depth, 0}));
  const double x = -5 * r - 1;
  const int frame = m.box({1.5 * r, 0.1, 0.4}, {x, r + 0.1, 0}, m.random.log_between(200, 5000));
  for (const double front : {-1.2, 1.2}) {
    for (const double side : {-0.55, 0.55}) {
      const int wheel = m.ball(r, {x + front * r, r, side * 1.6});
      m.join(Link::hinge, frame, wheel, m.body(wheel).position);
    }
  }
  for (GeneralBody& body : m.scene.bodies)
    if (body.moves()) body.velocity = {m.random.between(1.0, 1.001), 0, 0};
  m.scene.low = -2;
  m.set_friction(0.9);
  m.judge(Judge::gap, 0.005, 10);
}

// A chain dropped about a post.
void fill_chain_on_post(SceneMaker& m) {
  const int n = m.count(6, 40);
  const double half = 0.08, length = 2 * half * n, y = 0.6 * length + 1;
  m.ground();
  const int post = m.capsule(m.random.between(0.1, 0.4), 2, {0, y - 0.6, 0});
  m.fix(post);
  m.turn(post, turn_about({1, 0, 0}, std::numbers::pi / 2));
  int before = -1;
  const double shift = m.random.between(-0.15, 0.15) * length;
  for (int i = 0; i < n; ++i) {
    const double x = (2 * i + 1) * half - 0.5 * length + shift;
    const int link = m.capsule(0.03, half - 0.03, {x, y, 0}, 3000);
    m.turn(link, turn_about({0, 0, 1}, std::numbers::pi / 2));
    if (before >= 0) m.join(Link::ball, before, link, {x - half, y, 0});
    before = link;
  }
  m.set_friction(m.random.between(0.2, 0.9));
  m.judge(Judge::gap, 0.02, 8);
}

}  // namespace

void add_machine_families(std::vector<Family>& all) {
  all.insert(all.end(), {{"bridge", "4-40 planks on hinges, 0-8 boxes on it", fill_bridge},
                         {"suspension", "deck of 4-14 planks on rods, loads", fill_suspension},
                         {"rope", "4-40 capsules, load up to 300 : 1, about a post", fill_rope},
                         {"crane", "boom on a cable, load on a rope", fill_crane},
                         {"scissor", "scissor lift of 1-6 stages with a load", fill_scissor},
                         {"seesaw", "1-6 weights fall on a plank", fill_seesaw},
                         {"drawbridge", "deck on two chains, loads", fill_drawbridge},
                         {"cart", "four wheels on hinges into a rut", fill_cart},
                         {"chain-on-post", "6-40 links fall over a post", fill_chain_on_post}});
}

}  // namespace lockstone::bench
