// Rest on half-spaces: wherever the body is, the plane is as exact as at the origin.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/hull.h>
#include <lockstone/testing/floating.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

AssetPtr octahedron_like() {
  const std::array<Vec3<Length>, 8> points{{{0.5_m, 0.3_m, 0.2_m},
                                            {-0.5_m, 0.3_m, 0.2_m},
                                            {0.5_m, 0.3_m, -0.2_m},
                                            {-0.5_m, 0.3_m, -0.2_m},
                                            {0.3_m, -0.3_m, 0.4_m},
                                            {-0.3_m, -0.3_m, 0.4_m},
                                            {0.3_m, -0.3_m, -0.4_m},
                                            {-0.3_m, -0.3_m, -0.4_m}}};
  return Hull::build(points).hull;
}

/// Shapes that rest on the plane, the centre 0.3 m above it.
std::array<Shape, 4> resting_shapes(const AssetPtr& hull) {
  return {Shape::sphere(0.3_m), Shape::box(0.4_m, 0.3_m, 0.5_m), Shape::capsule(0.4_m, 0.3_m),
          hull->shape()};
}

double metres_between(const Vec3<Position>& a, const Vec3<Position>& b) {
  const auto d = a - b;
  return std::hypot(test::metres(d.x), test::metres(d.y), test::metres(d.z));
}

// The half-space's own origin stays at the world's origin: the plane is met far from it.
TEST(Resting, StaysPutOnAHalfSpaceAHundredKilometresAway) {
  const AssetPtr hull = octahedron_like();
  for (const Position place : {Position{}, Position(100000_m), Position(-1000000_m)}) {
    World world = test::make_world({.body_capacity = 8},
                                   std::make_shared<const AssetSet>(std::vector<AssetPtr>{hull}));
    BodyDef ground;
    ground.motion = MotionType::static_body;
    ground.shape = Shape::half_space();
    test::add(world, ground);
    std::array<BodyHandle, 4> bodies;
    std::array<Vec3<Position>, 4> start;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      BodyDef def =
          test::dynamic_body(resting_shapes(hull)[i],
                             place + Position::from_integer(3 * static_cast<int>(i)), 0.3_m, place);
      if (def.shape.kind == ShapeKind::capsule)
        def.orientation = from_axis_angle({{}, {}, 1_r}, 1.5707963_rad);
      bodies[i] = test::add(world, def);
      start[i] = def.position;
    }
    test::step(world, 300);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      EXPECT_LT(metres_between(world.position(bodies[i]), start[i]), 2e-3)
          << "shape " << i << " at " << test::metres(place) << " m";
      EXPECT_LT(abs(world.velocity(bodies[i]).y), Velocity(0.001_mps)) << "shape " << i;
    }
  }
}

// A slope of 20°, 100 km along it: friction 0.9 holds, friction 0 lets go.
TEST(Resting, HoldsOnASlantedHalfSpaceAHundredKilometresAway) {
  constexpr Angle k_slope = 0.3490659_rad;
  for (const bool rough : {true, false}) {
    World world = test::make_world({.body_capacity = 4});
    BodyDef ground;
    ground.motion = MotionType::static_body;
    ground.shape = Shape::half_space();
    ground.orientation = from_axis_angle({1_r, {}, {}}, k_slope);
    ground.material.friction = rough ? Coefficient(0.9_r) : Coefficient{};
    test::add(world, ground);
    const Mat3 axes = to_matrix(ground.orientation);
    const auto place = [&](std::int64_t along, std::int64_t up_mm) {
      Vec3<Position> result;
      for (int i = 0; i < 3; ++i) {
        const std::int64_t ahead = std::int64_t{axes.x[i].raw} + axes.z[i].raw;
        result[i] =
            Position::from_raw(ahead * 4 * along + std::int64_t{axes.y[i].raw} * up_mm / 250);
      }
      return result;
    };
    BodyDef def = test::dynamic_body(Shape::box(0.4_m, 0.3_m, 0.5_m), {}, {}, {});
    def.position = place(100000, 300);
    def.orientation = ground.orientation;
    def.material.friction = ground.material.friction;
    const BodyHandle body = test::add(world, def);
    test::step(world, 120);
    const double way = metres_between(world.position(body), def.position);
    const double expected = rough ? 0 : 9.81 * std::sin(0.3490659) * 2 * 2 / 2;
    EXPECT_NEAR(way, expected, 0.02);  // sliding is of first order: 0.014 m
  }
}

}  // namespace
}  // namespace lockstone
