// Scenes that only a converged solution of contacts and friction holds: of builds with
// LOCKSTONE_CONVERGED_ISLANDS.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

using test::metres;

double distance(const Vec3<Position>& a, const Vec3<Position>& b) {
  return std::hypot(metres(a.x - b.x), metres(a.y - b.y), metres(a.z - b.z));
}

// Steps for so long; how far the bodies went in that time.
double greatest_way(World& world, const std::vector<BodyHandle>& bodies, int ticks) {
  std::vector<Vec3<Position>> starts;
  for (const BodyHandle body : bodies)
    starts.push_back(world.position(body));
  test::step(world, ticks);
  double most = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    most = std::max(most, distance(world.position(bodies[i]), starts[i]));
  return most;
}

// One of boxes off by up to 3 cm, whose height is that of 40.
TEST(Converged, AStackOutOfLineStands) {
  World world = test::make_world({.body_capacity = 64, .sleep_ms = 0});
  test::add_ground(world);
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < 40; ++i) {
    const Position x = Position::from_ratio(i * 37 % 61 - 30, 1000);
    boxes.push_back(test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), x,
                                                        Position::from_ratio(2 * i + 1, 2), {})));
  }
  EXPECT_LT(greatest_way(world, boxes, 900), 0.005);
}

TEST(Converged, ALightBoxCarriesThousandsOfTimesItsWeight) {
  for (const int ratio : {10, 400, 1000, 5000}) {
    World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
    test::add_ground(world);
    const Shape box = Shape::box(0.5_m, 0.5_m, 0.5_m);
    std::vector<BodyHandle> boxes;
    BodyDef heavy = test::dynamic_body(box, {}, 1.5_m, {});
    heavy.material.density = Density::from_integer(ratio);
    BodyDef light = test::dynamic_body(box, {}, 0.5_m, {});
    light.material.density = Density::from_integer(1);
    boxes.push_back(test::add(world, light));
    boxes.push_back(test::add(world, heavy));
    EXPECT_LT(greatest_way(world, boxes, 600), 0.002) << ratio;
  }
}

}  // namespace
}  // namespace lockstone
