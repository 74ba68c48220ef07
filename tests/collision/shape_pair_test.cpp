// Two shapes without a world: distances, contacts and impacts beside references in long double.
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/rotation.h>
#include <lockstone/shape_pair.h>

#include "tests/geometry/assets/asset_parts.h"

namespace lockstone::test {
namespace {

Vec3<Position> place(double x, double y, double z) {
  return rounded<Position>(metres(x, y, z));
}

ShapeAt at(const Shape& shape, double x, double y, double z, const Quat& turn = {}) {
  return {shape, {place(x, y, z), turn}, nullptr};
}

ShapeAt at(const AssetPtr& asset, double x, double y, double z, const Quat& turn = {}) {
  return {asset->shape(), {place(x, y, z), turn}, asset.get()};
}

Placed reference(const ShapeAt& at) {
  const Mat3 rotation = to_matrix(normalized(at.pose.orientation));
  return {PosedShape{at.shape, rotation}, real(at.pose.position)};
}

ShapeAt random_at(Dice& dice, double reach) {
  const Shape shape = dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.05, 1);
  const double x = dice.uniform(-reach, reach);
  const double y = dice.uniform(-reach, reach);
  const double z = dice.uniform(-reach, reach);
  return at(shape, x, y, z, dice.orientation());
}

constexpr Angle k_quarter = Angle::from_raw(210828714);  // π/2

double metres_of(Position x) {
  return static_cast<double>(real(x));
}
double fraction_of(Unit x) {
  return static_cast<double>(real(x));
}

TEST(ShapePair, DistanceIsThatOfTheReference) {
  Dice dice(1);
  int apart = 0, overlapping = 0;
  for (int i = 0; i < 2000; ++i) {
    const ShapeAt a = random_at(dice, 1.5);
    const ShapeAt b = random_at(dice, 1.5);
    const auto truth = static_cast<double>(signed_distance(reference(a), reference(b)));
    const ShapeDistance found = shape_distance(a, b).value();
    ASSERT_TRUE(found.found);
    if (truth > 4e-6) {
      ++apart;
      EXPECT_FALSE(found.overlapping);
      EXPECT_NEAR(metres_of(found.distance), truth, 2.1e-6);
      const RealVec between = real(found.point_b) - real(found.point_a);
      EXPECT_NEAR(static_cast<double>(norm(between)), truth, 5e-6);
      EXPECT_NEAR(static_cast<double>(dot(between, real(found.normal))), truth, 5e-6);
    } else if (truth < -4e-6) {
      ++overlapping;
      EXPECT_TRUE(found.overlapping);
      EXPECT_EQ(found.distance, Position{});
      EXPECT_EQ(found.normal, Vec3<Unit>{});
    }
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(overlapping, 100);
}

TEST(ShapePair, DistanceIsMirroredWhereTheShapesAreExchanged) {
  Dice dice(2);
  for (int i = 0; i < 500; ++i) {
    const ShapeAt a = random_at(dice, 2);
    const ShapeAt b = random_at(dice, 2);
    const ShapeDistance one = shape_distance(a, b).value();
    const ShapeDistance other = shape_distance(b, a).value();
    EXPECT_EQ(one.distance, other.distance);
    EXPECT_EQ(one.normal, -other.normal);
    EXPECT_EQ(one.point_a, other.point_b);
    EXPECT_EQ(one.point_b, other.point_a);
  }
}

TEST(ShapePair, FarFromTheOriginAllIsAsExact) {
  ShapeAt a = at(Shape::sphere(metres(0.5)), 0, 0, 0);
  ShapeAt b = at(Shape::sphere(metres(0.25)), 2, 0, 0);
  for (ShapeAt* shape : {&a, &b})
    shape->pose.position.x += Position::from_integer(1'000'000);
  const ShapeDistance found = shape_distance(a, b).value();
  EXPECT_EQ(found.distance, Position::from_ratio(5, 4));
  EXPECT_EQ(found.point_b.x, Position::from_ratio(4'000'007, 4));
}

TEST(ShapePair, ReachEndsWhereItSays) {
  const ShapeAt a = at(Shape::sphere(metres(0.5)), 0, 0, 0);
  const ShapeAt b = at(Shape::sphere(metres(0.5)), 0, 3, 0);
  const Length gap = metres(2);
  EXPECT_TRUE(shape_distance(a, b, gap).value().found);
  EXPECT_FALSE(shape_distance(a, b, gap - Length::from_raw(1)).value().found);
}

struct Cluster {
  AssetPtr asset;
  std::vector<ShapeAt> children;  // as they are where the compound is
};

Cluster random_cluster(Dice& dice, const Transform& pose) {
  std::vector<CompoundChild> children(6);
  Cluster cluster;
  for (CompoundChild& child : children) {
    child.shape = dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.1, 0.5);
    for (int i = 0; i < 3; ++i)
      child.position[i] = metres(dice.uniform(-2, 2));
    child.orientation = dice.orientation();
    cluster.children.push_back(
        {child.shape, compose(pose, {rounded<Position>(child.position), child.orientation}),
         nullptr});
  }
  cluster.asset = Compound::build(children).compound;
  return cluster;
}

TEST(ShapePair, OfCompoundsTheNearestPartsCount) {
  Dice dice(3);
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const Transform pose_a{place(0, 0, 0), dice.orientation()};
    const Transform pose_b{place(dice.uniform(3, 6), 0, 0), dice.orientation()};
    const Cluster a = random_cluster(dice, pose_a);
    const Cluster b = random_cluster(dice, pose_b);
    const ShapeAt whole_a{a.asset->shape(), pose_a, a.asset.get()};
    const ShapeAt whole_b{b.asset->shape(), pose_b, b.asset.get()};
    Real nearest = 1e9L;
    for (const ShapeAt& child_a : a.children) {
      for (const ShapeAt& child_b : b.children)
        nearest = std::min(nearest, signed_distance(reference(child_a), reference(child_b)));
    }
    const ShapeDistance found = shape_distance(whole_a, whole_b).value();
    EXPECT_NEAR(metres_of(found.distance), static_cast<double>(std::max<Real>(nearest, 0)), 4e-6);
    if (found.overlapping) continue;
    ++hits;
    const Real of_parts =
        signed_distance(reference(a.children[found.part_a]), reference(b.children[found.part_b]));
    EXPECT_NEAR(metres_of(found.distance), static_cast<double>(of_parts), 4e-6);
  }
  EXPECT_GT(hits, 30);
}

TEST(ShapePair, HalfSpacesAndMeshesMeetSolidShapesInEitherOrder) {
  const ShapeAt ground = at(Shape::half_space(), 0, 1, 0);
  const ShapeAt box = at(Shape::box(metres(1), metres(0.5), metres(1)), 900, 3, -900);
  const ShapeDistance above = shape_distance(box, ground).value();
  EXPECT_EQ(above.distance, Position::from_ratio(3, 2));
  EXPECT_EQ(above.normal, (Vec3<Unit>{{}, Unit::from_integer(-1), {}}));
  EXPECT_EQ(shape_distance(ground, box).value().normal, -above.normal);

  const AssetPtr mesh = Mesh::build(cube(1).def()).mesh;
  const ShapeAt on_cube = at(Shape::sphere(metres(0.5)), 0.25, 2, 0);
  const ShapeDistance to_mesh = shape_distance(on_cube, at(mesh, 0, 0, 0)).value();
  EXPECT_NEAR(metres_of(to_mesh.distance), 0.5, 2e-6);
  EXPECT_NEAR(metres_of(to_mesh.point_b.y), 1, 2e-6);
  EXPECT_EQ(shape_distance(at(mesh, 0, 0, 0), on_cube).value().part_a, to_mesh.part_b);

  std::array<ShapeManifold, 8> one, other;
  const ShapeAt sunk = at(Shape::box(metres(1), metres(0.5), metres(1)), 0, 1.25, 0);
  ASSERT_EQ(shape_contacts(sunk, ground, metres(0.01), one).value(), 1u);
  ASSERT_EQ(shape_contacts(ground, sunk, metres(0.01), other).value(), 1u);
  EXPECT_EQ(one[0].count, 4u);
  EXPECT_EQ(one[0].normal, -other[0].normal);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(one[0].points[i].separation, Displacement::from_ratio(-1, 4));
    EXPECT_EQ(one[0].points[i].point_a, other[0].points[i].point_b);
  }
}

TEST(ShapePair, ContactsAreThoseOfTheReference) {
  Dice dice(4);
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const ShapeAt a = random_at(dice, 1);
    const ShapeAt b = random_at(dice, 1);
    const Real truth = signed_distance(reference(a), reference(b));
    std::array<ShapeManifold, 2> out;
    const std::size_t count = shape_contacts(a, b, metres(0.05), out).value();
    if (truth > 0.0501L) {
      EXPECT_EQ(count, 0u);
    }
    if (truth > 0.0499L || truth < 1e-5L) continue;
    ASSERT_EQ(count, 1u);
    ++met;
    Real least = 1;
    for (std::size_t k = 0; k < out[0].count; ++k) {
      const ShapeManifold::Point& point = out[0].points[k];
      least = std::min(least, real(point.separation));
      const RealVec between = real(point.point_b) - real(point.point_a);
      EXPECT_NEAR(static_cast<double>(dot(between, real(out[0].normal))),
                  static_cast<double>(real(point.separation)), 4e-5);
    }
    EXPECT_NEAR(static_cast<double>(least), static_cast<double>(truth), 4e-5);
  }
  EXPECT_GT(met, 15);
}

TEST(ShapePair, ACastOfABallHitsWhereTheEquationSays) {
  Dice dice(5);
  const ShapeAt a = at(Shape::sphere(metres(0.75)), 1, 2, 3);
  int hits = 0, misses = 0;
  for (int i = 0; i < 500; ++i) {
    const ShapeAt b = at(Shape::sphere(metres(0.5)), dice.uniform(-6, -2), 2, 3);
    const Vec3<Length> way = metres(8, dice.uniform(-3, 3), dice.uniform(-3, 3));
    // |offset + t way| = 5/4
    const RealVec offset = real(b.pose.position) - real(a.pose.position);
    const Real half = dot(offset, real(way)), square = dot(real(way), real(way));
    const Real root = half * half - square * (dot(offset, offset) - 1.5625L);
    const ShapeImpact hit = shape_cast(a, b, way).value();
    EXPECT_EQ(hit.hit, root > 0);
    if (!hit.hit) {
      ++misses;
      continue;
    }
    ++hits;
    EXPECT_FALSE(hit.overlapping);
    if (root > 1) {
      const Real time = (-half - std::sqrt(root)) / square;
      EXPECT_NEAR(fraction_of(hit.fraction), static_cast<double>(time), 1e-5);
    }
    EXPECT_NEAR(static_cast<double>(norm(real(hit.point_a) - real(a.pose.position))), 0.75, 4e-6);
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(misses, 50);
  EXPECT_TRUE(shape_cast(a, at(Shape::sphere(metres(0.5)), 1, 2, 3.5), metres(1, 0, 0))
                  .value()
                  .overlapping);
}

TEST(ShapePair, ATurningRodMeetsABallAtTheAngleOfItsTangent) {
  // A capsule along x about the origin turns about z by 90°; a ball stands at (0, 2, 0).
  const Quat along_x = from_axis_angle({{}, {}, Unit::from_integer(1)}, -k_quarter);
  const ShapeAt rod = at(Shape::capsule(metres(2), metres(0.1)), 0, 0, 0, along_x);
  const ShapeAt ball = at(Shape::sphere(metres(0.4)), 0, 2, 0);
  const ShapeMotion turning{rod, {rod.pose.position, {}}};
  const ShapeMotion still{ball, ball.pose};
  const Length gap = Length::from_raw(8);
  const ShapeImpact hit = shape_impact(turning, still, gap).value();
  ASSERT_TRUE(hit.hit);
  // The core's line is 0.5 from the ball's centre: 2 cos φ = 0.5 by the angle φ already turned.
  const double angle = std::acos(0.5 / 2);
  EXPECT_NEAR(fraction_of(hit.fraction), angle / (std::numbers::pi / 2), 2e-5);
  EXPECT_FALSE(hit.overlapping);
  const ShapeImpact mirrored = shape_impact(still, turning, gap).value();
  EXPECT_EQ(mirrored.fraction, hit.fraction);
  EXPECT_EQ(mirrored.normal, -hit.normal);

  // The same rod as the second child of a compound beside a ball that meets nothing.
  std::array<CompoundChild, 2> children;
  children[0].shape = Shape::sphere(metres(0.2));
  children[1].shape = rod.shape;
  children[1].orientation = along_x;
  const AssetPtr compound = Compound::build(children).compound;
  const Quat turn = from_axis_angle({{}, {}, Unit::from_integer(1)}, k_quarter);
  const ShapeImpact by_part = shape_impact({at(compound, 0, 0, 0), {{}, turn}}, still, gap).value();
  EXPECT_EQ(by_part.part_a, 1u);
  EXPECT_NEAR(fraction_of(by_part.fraction), fraction_of(hit.fraction), 2e-6);
}

TEST(ShapePair, AnImpactWithoutATurnIsACastToTheGap) {
  Dice dice(6);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const ShapeAt a = random_at(dice, 1);
    ShapeAt b = random_at(dice, 1);
    b.pose.position.x += Position::from_integer(5);
    const Vec3<Length> way = metres(-6, 0, 0);
    const ShapeImpact cast = shape_cast(a, b, way).value();
    Transform end = b.pose;
    end.position += rounded<Position>(way);
    const ShapeImpact found = shape_impact({a, a.pose}, {b, end}, Length::from_raw(8)).value();
    if (!cast.hit) continue;
    ++hits;
    ASSERT_TRUE(found.hit);
    EXPECT_LE(fraction_of(found.fraction), fraction_of(cast.fraction) + 1e-6);
    ShapeAt stopped = b;
    stopped.pose.position += rounded<Position>(metres(-6 * fraction_of(found.fraction), 0, 0));
    const double left = metres_of(shape_distance(a, stopped).value().distance);
    EXPECT_NEAR(left, 9e-6, 6e-6);
  }
  EXPECT_GT(hits, 50);
}

TEST(ShapePair, RefusesShapesPlacesAndPairsOutsideTheirRanges) {
  const ShapeAt ball = at(Shape::sphere(metres(0.5)), 0, 0, 0);
  const ShapeAt ground = at(Shape::half_space(), 0, 0, 0);
  const AssetPtr hull = Hull::build(cube(1).vertices).hull;
  const auto refused = [&](const ShapeAt& a, const ShapeAt& b) {
    std::array<ShapeManifold, 1> out;
    return shape_distance(a, b).status() == Status::invalid_argument &&
           shape_contacts(a, b, {}, out).status() == Status::invalid_argument &&
           shape_cast(a, b, {}).status() == Status::invalid_argument &&
           shape_impact({a, a.pose}, {b, b.pose}).status() == Status::invalid_argument;
  };
  EXPECT_FALSE(refused(ball, ball));
  EXPECT_FALSE(refused(ball, at(hull, 0, 0, 0)));
  EXPECT_TRUE(refused(ground, ground));
  EXPECT_TRUE(refused(ball, at(Shape::sphere({}), 0, 0, 0)));
  EXPECT_TRUE(refused(ball, at(Shape{ShapeKind::path, {}, {7}}, 0, 0, 0)));
  EXPECT_TRUE(refused(ball, {hull->shape(), {}, nullptr}));
  EXPECT_TRUE(refused(ball, {Shape{ShapeKind::hull, {}, {7}}, {}, hull.get()}));
  EXPECT_TRUE(refused(ball, at(Shape::sphere(metres(0.5)), 1000.5, 0, 0)));
  EXPECT_TRUE(refused(ball, at(Shape::sphere(metres(0.5)), 0, 0, 0, {{}, {}, {}, {}})));
  EXPECT_EQ(shape_distance(ball, ball, metres(513)).status(), Status::invalid_argument);
  EXPECT_EQ(shape_cast(ball, ball, metres(0, 513, 0)).status(), Status::invalid_argument);
  EXPECT_EQ(shape_cast(ball, ground, {}).status(), Status::invalid_argument);
  EXPECT_EQ(shape_impact({ball, ball.pose}, {ground, ground.pose}).status(),
            Status::invalid_argument);
  EXPECT_EQ(shape_impact({ball, ball.pose}, {ball, ball.pose}, Length::from_raw(7)).status(),
            Status::invalid_argument);
}

}  // namespace
}  // namespace lockstone::test
