// Whether bodies overlap, found by a shortcut or by all of their contacts.
#include <gtest/gtest.h>

#include <lockstone/mesh.h>

#include "core/collision/narrow_phase/collide_bodies.h"
#include "tests/collision/random_rock.h"

namespace lockstone::test {
namespace {

PlacedShape placed_near(Dice& dice, const Shape& shape, const Asset* asset, double reach) {
  Vec3<Position> at;
  for (int i = 0; i < 3; ++i)
    at[i] = rounded<Position>(metres(dice.uniform(-reach, reach)));
  return {shape, geometry::geometry_of(asset), at, to_matrix(dice.orientation()), at};
}

// Balls of every size about hulls and primitives: inside, across their surfaces and beside them.
TEST(BodiesOverlap, AgreesWithTheContactsOfBalls) {
  Dice dice;
  PartContacts contacts;
  int overlapping = 0, apart = 0;
  for (int round = 0; round < 4000; ++round) {
    const AssetPtr rock = round % 2 == 0 ? random_rock(dice, 20, 1, 1, 1) : nullptr;
    const Shape shape = rock != nullptr
                            ? rock->shape()
                            : dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.1, 1);
    const Shape ball = Shape::sphere(metres(dice.uniform(0.001, 3)));
    const PlacedShape a = placed_near(dice, ball, nullptr, 1.5);
    const PlacedShape b = placed_near(dice, shape, rock.get(), 1.5);
    collide_bodies(a, b, {}, nullptr, contacts);
    const bool meet = contacts.count > 0;
    ASSERT_EQ(bodies_overlap(a, b), meet) << "round " << round;
    ASSERT_EQ(bodies_overlap(b, a), meet) << "round " << round;
    (meet ? overlapping : apart) += 1;
  }
  EXPECT_GT(overlapping, 500);
  EXPECT_GT(apart, 500);
}

// The control: a triangle inside a ball does not count when the ball's centre is behind it.
TEST(BodiesOverlap, HoldsToTheFrontOfTriangles) {
  const Vec3<Length> vertices[3] = {metres(-1, 0, -1), metres(-1, 0, 1), metres(1, 0, 0)};
  const TriangleIndices triangle[1] = {{0, 1, 2}};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangle;
  const AssetPtr sheet = Mesh::build(def).mesh;
  const auto ball_meets = [&](double y) {
    const Vec3<Position> at{{}, rounded<Position>(metres(y)), {}};
    const PlacedShape ball{Shape::sphere(metres(2)), nullptr, at, to_matrix(Quat{}), at};
    return bodies_overlap(ball, {sheet->shape(), &sheet->geometry(), {}, to_matrix(Quat{}), {}});
  };
  EXPECT_NE(ball_meets(0.5), ball_meets(-0.5));
}

// From every side and at every distance, those included that no length holds.
TEST(BodiesOverlap, AgreesWithContactsFarFromPlanes) {
  Dice dice;
  PartContacts contacts;
  for (const int distance :
       {-900000, -4096, -2049, -2048, -2047, -1500, -1, 1, 1500, 2048, 900000}) {
    const Mat3 rotation = distance % 2 == 0 ? to_matrix(Quat{}) : to_matrix(dice.orientation());
    const PlacedShape plane{Shape::half_space(), nullptr, {}, rotation, {}};
    const Vec3<Position> at = rotate(rotation, {{}, Position::from_integer(distance), {}});
    const PlacedShape box{Shape::box(metres(0.5), metres(0.5), metres(0.5)), nullptr, at, rotation,
                          at};
    collide_bodies(box, plane, {}, nullptr, contacts);
    EXPECT_EQ(contacts.count > 0, distance < 0) << distance;
    EXPECT_EQ(bodies_overlap(box, plane), distance < 0) << distance;
    EXPECT_EQ(bodies_overlap(plane, box), distance < 0) << distance;
  }
}

}  // namespace
}  // namespace lockstone::test
