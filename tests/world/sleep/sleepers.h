// Boxes that sleep, for tests of sleeping and waking.
#pragma once

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone::test {

using namespace literals;

constexpr Shape unit_box() {
  return Shape::box(0.5_m, 0.5_m, 0.5_m);
}

inline std::vector<BodyHandle> add_stack(World& world, Position x, int count) {
  std::vector<BodyHandle> stack;
  for (int i = 0; i < count; ++i) {
    const Position y = Position::from_ratio(2 * i + 1, 2);
    stack.push_back(add(world, dynamic_body(unit_box(), x, y, {})));
  }
  return stack;
}

inline bool asleep(const World& world, BodyHandle body) {
  return world.body(body).is_asleep;
}

inline bool all_asleep(const World& world, const std::vector<BodyHandle>& bodies) {
  return std::ranges::all_of(bodies, [&](BodyHandle body) { return asleep(world, body); });
}

// A stack of three that sleeps on the ground.
struct Sleepers {
  World world = make_world();
  BodyHandle ground = add_ground(world);
  std::vector<BodyHandle> stack = add_stack(world, {}, 3);

  Sleepers() {
    step(world, 90);
    EXPECT_TRUE(all_asleep(world, stack));
  }
};

}  // namespace lockstone::test
