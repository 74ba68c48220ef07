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

// It gets its loads in the tick in which it is made, and keeps them. By soft steps alone its boxes
// sank by up to 17 mm, and a little larger ones trembled.
TEST(SoftSteps, LetAPyramidStandWhereItIsPut) {
  World world = test::make_world({.body_capacity = 256, .converged_contacts = 0});
  test::add_ground(world);
  std::vector<BodyHandle> boxes;
  std::vector<Vec3<Position>> start;
  for (int row = 0; row < 12; ++row) {
    for (int i = 0; i < 12 - row; ++i) {
      boxes.push_back(
          test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m),
                                              Position::from_ratio(11 * (2 * i + row), 20),
                                              Position::from_ratio(2 * row + 1, 2), {})));
      start.push_back(world.position(boxes.back()));
    }
  }
  test::step(world, 300);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(test::metres(world.position(boxes[i])[axis]), test::metres(start[i][axis]), 5e-4)
          << i;
  }
}

}  // namespace
}  // namespace lockstone
