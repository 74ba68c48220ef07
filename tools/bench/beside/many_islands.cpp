#include "tools/bench/beside/many_islands.h"

#include <algorithm>
#include <cmath>

#include "tools/bench/general/maker.h"

namespace lockstone::bench {
namespace {

using namespace general;

constexpr int k_ticks = 120;

void add_stack(SceneMaker& m, const Triple& at) {
  for (int i = 0; i < 5; ++i)
    m.box({0.5, 0.5, 0.5}, at + Triple{0, i + 0.5, 0});
}

// Ten boxes of many sizes fall onto each other.
void add_pile(SceneMaker& m, const Triple& at) {
  for (int i = 0; i < 10; ++i) {
    const Triple aside = m.jitter(0.3);
    Triple half = m.jitter(0.15);
    for (double& x : half)
      x += 0.3;
    const int box = m.box(half, at + Triple{aside[0], 0.6 + i, aside[2]});
    m.turn(box, m.any_turn());
  }
}

// Thrown aside, or it would stand.
void add_thrown(SceneMaker& m, const Triple& at) {
  const std::size_t first = m.scene.bodies.size();
  add_ragdoll(m, at + Triple{0, 1.2, 0});
  const Triple velocity = 2.0 * m.direction();
  for (std::size_t i = first; i < m.scene.bodies.size(); ++i)
    m.scene.bodies[i].velocity = velocity;
}

// On a square grid.
template <void (*add)(SceneMaker&, const Triple&)>
GeneralScene on_ground(int islands, double spacing) {
  SceneMaker m("islands", 1, k_no_cap);
  const int side = static_cast<int>(std::ceil(std::sqrt(islands)));
  const double half = spacing * side / 2;
  m.fix(m.box({half + spacing, 1, half + spacing}, {0, -1, 0}));
  for (int i = 0; i < islands; ++i)
    add(m, {(i % side + 0.5) * spacing - half, 0, (i / side + 0.5) * spacing - half});
  return std::move(m.scene);
}

constexpr IslandKind k_kinds[] = {
    {"stacks", "five boxes on each other", 5,
     [](int islands) { return on_ground<add_stack>(islands, 2); }},
    {"piles", "ten boxes of 0.3 to 0.9 m fall onto each other", 10,
     [](int islands) { return on_ground<add_pile>(islands, 6); }},
    {"ragdolls", "ten bodies and nine joints fall over", 10,
     [](int islands) { return on_ground<add_thrown>(islands, 4); }},
};

}  // namespace

std::span<const IslandKind> island_kinds() {
  return k_kinds;
}

GeneralScene make_islands(const IslandKind& kind, int bodies) {
  GeneralScene scene = kind.make(std::max(1, bodies / kind.bodies));
  scene.family = kind.name;
  scene.ticks = k_ticks;
  return scene;
}

}  // namespace lockstone::bench
