// Small islands that iterations alone solve come to rest.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres_per_second;

double fastest(const World& world, const std::vector<BodyHandle>& bodies) {
  double most = 0;
  for (const BodyHandle body : bodies) {
    const Vec3<Velocity> v = world.velocity(body);
    for (int i = 0; i < 3; ++i)
      most = std::max(most, std::abs(metres_per_second(v[i])));
  }
  return most;
}

// Their points change names while they settle. Where new points began without an impulse, the boxes
// rattled at 10 mm/s until they slept after three seconds.
TEST(SoftSteps, LetAStackOfFiveComeToRestWithinASecond) {
  World world = test::make_world({.body_capacity = 16, .converged_contacts = 0});
  test::add_ground(world);
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {},
                                                        Position::from_ratio(2 * i + 1, 2), {})));
  test::step(world, 60);
  EXPECT_LT(fastest(world, boxes), 1e-3);
}

}  // namespace
}  // namespace lockstone
