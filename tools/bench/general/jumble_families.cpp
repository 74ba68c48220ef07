// Whatever can be built: bodies of any size and mass, joined in any way and thrown about.
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/bench/general/maker.h"
#include "tools/bench/general/vectors.h"

namespace lockstone::bench {
namespace {

using namespace general;

// Half the side of the cell that each body has to itself at first.
constexpr double k_cell = 0.5;

int any_body(SceneMaker& m, const Triple& at) {
  const double density = m.random.log_between(50, 10000);
  const auto half = [&] { return m.random.log_between(0.05, 0.28); };
  switch (m.random.count(0, 2)) {
    case 0:
      return m.ball(half(), at, density);
    case 1: {
      const double radius = 0.5 * half();
      return m.capsule(radius, half(), at, density);
    }
    default:
      return m.box({half(), half(), half()}, at, density);
  }
}

void join_any(SceneMaker& m, int a, int b) {
  const Triple from = m.body(a).position, to = m.body(b).position;
  const Triple off_a = m.jitter(0.2), off_b = m.jitter(0.2);
  const double part = m.random.between(0, 1);
  const Triple at = from + off_a + part * (to - from);
  const int kind = m.random.count(0, 4);
  if (kind == 4) {
    GeneralJoint& rod = m.rod(a, b, from + off_a, to + off_b);
    rod.limited = m.random.chance(0.4);
    if (rod.limited) {
      rod.lower = rod.target * m.random.between(0, 1);
      rod.upper = rod.target * m.random.between(1, 2);
    }
    return;
  }
  GeneralJoint& joint = m.join(static_cast<Link>(kind), a, b, at, m.direction());
  joint.limited = (joint.link == Link::hinge || joint.link == Link::slider) && m.random.chance(0.5);
  if (joint.limited) {
    joint.lower = -m.random.between(0, 1);
    joint.upper = m.random.between(0, 1);
  }
}

struct Jumble {
  int most_bodies = 12;
  bool is_grounded = true;
  bool is_joined = true;
  double seconds = 2;
};

// Bodies on a grid, some joined to neighbours or to the world, all thrown.
void fill(SceneMaker& m, const Jumble& jumble) {
  const int n = m.count(1, jumble.most_bodies), side = m.random.count(1, 3);
  const double joined = !jumble.is_joined || m.random.chance(0.2) ? 0 : m.random.between(0.2, 1);
  const double speed = m.random.between(0, 10), spin = m.random.between(0, 20);
  const double bounce = m.random.chance(0.2) ? m.random.between(0, 1) : 0;
  if (jumble.is_grounded) m.ground();
  std::vector<int> bodies;
  for (int i = 0; i < n; ++i) {
    const Triple at{2 * k_cell * (i % side), k_cell * (1 + 2 * (i / (side * side))),
                    2 * k_cell * (i / side % side)};
    const int body = any_body(m, at);
    m.turn(body, m.any_turn());
    const Triple way = m.direction(), axis = m.direction();
    m.body(body).velocity = speed * way;
    m.body(body).angular_velocity = spin * axis;
    m.body(body).restitution = bounce;
    m.body(body).collides = jumble.is_grounded;
    bodies.push_back(body);
  }
  const auto join = [&](int i, int back) {
    if (i >= back && m.random.chance(joined))
      join_any(m, bodies[static_cast<std::size_t>(i - back)], bodies[static_cast<std::size_t>(i)]);
  };
  for (int i = 0; i < n; ++i) {
    join(i, 1);
    if (side > 1) join(i, side);
    if (m.random.chance(0.1 * joined))
      join_any(m, m.anchor(m.body(bodies[static_cast<std::size_t>(i)]).position + m.jitter(1)),
               bodies[static_cast<std::size_t>(i)]);
  }
  m.set_friction(m.random.between(0, 1));
  if (!jumble.is_grounded) m.scene.gravity = 0;
  m.judge(Judge::gain, 0.05, jumble.seconds);
}

void fill_jumble(SceneMaker& m) {
  fill(m, {});
}
// The same in short, for many seeds.
void fill_fling(SceneMaker& m) {
  fill(m, {.most_bodies = 5, .is_grounded = false, .seconds = 0.5});
}
void fill_toss(SceneMaker& m) {
  fill(m, {.most_bodies = 5, .seconds = 0.75});
}
void fill_spill(SceneMaker& m) {
  fill(m, {.most_bodies = 8, .is_joined = false, .seconds = 0.75});
}

}  // namespace

void add_jumble_families(std::vector<Family>& all) {
  all.insert(all.end(),
             {{"jumble", "1-12 bodies of any size, joined any way, thrown: energy", fill_jumble},
              {"fling", "1-5 such bodies in free space, for half a second", fill_fling},
              {"toss", "1-5 such bodies over the ground, briefly", fill_toss},
              {"spill", "1-8 such bodies without joints over the ground, briefly", fill_spill}});
}

}  // namespace lockstone::bench
