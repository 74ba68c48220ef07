// Static bodies side by side are met as one surface; real steps, walls and rims are still met.
#include "core/collision/narrow_phase/seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/testing/floating.h>
#include <lockstone/thread_pool.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

constexpr Length k_half = 0.5_m;  // of a tile

enum class Tile { box, hull, compound, mesh, height_field, mixed };

std::vector<Vec3<Length>> corners(const Vec3<Length>& half) {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back({(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                      (i & 4) != 0 ? half.z : -half.z});
  return points;
}

AssetPtr tile_mesh() {
  const std::vector<Vec3<Length>> points{{-k_half, k_half, -k_half},
                                         {-k_half, k_half, k_half},
                                         {k_half, k_half, k_half},
                                         {k_half, k_half, -k_half}};
  const std::array triangles{TriangleIndices{0, 1, 2}, TriangleIndices{0, 2, 3}};
  MeshDef def;
  def.vertices = points;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

AssetPtr tile_field() {
  const std::vector<Length> heights(9, k_half);
  HeightFieldDef def;
  def.columns = def.rows = 3;
  def.cell_x = def.cell_z = k_half;
  def.origin = {-k_half, {}, -k_half};
  def.heights = heights;
  return HeightField::build(def).height_field;
}

// Three boxes in a row across the way.
AssetPtr tile_row() {
  std::array<CompoundChild, 3> children;
  for (int i = 0; i < 3; ++i) {
    children[static_cast<std::size_t>(i)].shape = Shape::box(k_half, k_half, k_half);
    children[static_cast<std::size_t>(i)].position = {{}, {}, k_half * (2 * i - 2)};
  }
  return Compound::build(children).compound;
}

struct Assets {
  AssetPtr hull = Hull::build(corners({k_half, k_half, k_half})).hull;
  AssetPtr mesh = tile_mesh(), field = tile_field(), row = tile_row();
  AssetPtr brick = Hull::build(corners({0.3_m, 0.2_m, 0.25_m})).hull;

  [[nodiscard]] std::shared_ptr<const AssetSet> set() const {
    return std::make_shared<const AssetSet>(std::vector<AssetPtr>{hull, mesh, field, row, brick});
  }
  [[nodiscard]] Shape shape(Tile tile) const {
    switch (tile) {
      case Tile::hull:
        return hull->shape();
      case Tile::compound:
        return row->shape();
      case Tile::mesh:
        return mesh->shape();
      case Tile::height_field:
        return field->shape();
      default:
        return Shape::box(k_half, k_half, k_half);
    }
  }
};

Position raised(Length height) {
  return rounded<Position>(height);
}

void add_fixed(World& world, const Shape& shape, const Vec3<Position>& at, Coefficient friction) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = shape;
  def.position = at;
  def.material.friction = friction;
  test::add(world, def);
}

/// Three rows of tiles from −2 m to the length; their tops are at y = 0, up to `jitter` above or
/// below it.
void add_tiles(World& world, const Assets& assets, Tile kind, int length, Coefficient friction,
               Length jitter = {}) {
  constexpr std::array k_kinds{Tile::box, Tile::hull, Tile::mesh, Tile::height_field};
  for (int i = -2; i < length; ++i) {
    for (int row = -1; row <= 1; ++row) {
      if (kind == Tile::compound && row != 0) continue;
      const auto turn = static_cast<std::size_t>(7 * i + 3 * row + 21) % 4;
      const Length up = jitter * (static_cast<int>((5 * i + row + 20) % 3) - 1);
      add_fixed(
          world, assets.shape(kind == Tile::mixed ? k_kinds[turn] : kind),
          {Position::from_integer(i), -raised(k_half) + raised(up), Position::from_integer(row)},
          friction);
    }
  }
}

struct Course {
  double highest = 0;  // m above the beginning
  double speed = 0;    // along the way at the end
  bool has_room = true;
};

Course travel(World& world, BodyHandle body, int ticks) {
  const double start = metres(world.body(body).position.y);
  Course course;
  for (int i = 0; i < ticks; ++i) {
    course.has_room = world.step().status == Status::ok && course.has_room;
    course.highest = std::max(course.highest, metres(world.body(body).position.y) - start);
  }
  course.speed = metres_per_second(world.body(body).velocity.x);
  return course;
}

Course roll(Tile kind, int speed, const Shape& shape, Length jitter = {}) {
  const Assets assets;
  World world = test::make_world({}, assets.set());
  add_tiles(world, assets, kind, 2 * speed + 3, 0.6_r, jitter);
  const Length radius = shape.size.x;
  BodyDef def = test::dynamic_body(shape, {}, rounded<Position>(radius), 0.13_m);
  def.orientation = from_axis_angle({1_r, {}, {}}, 1.5707963_rad);
  def.velocity = {Velocity::from_integer(speed), {}, {}};
  def.angular_velocity.z = AngularVelocity::from_raw(-(std::int64_t{speed} << 52) / radius.raw);
  def.material.friction = 0.6_r;
  return travel(world, test::add(world, def), 120);
}

Course slide(Tile kind, int speed, const Shape& shape, Length height, Length jitter = {}) {
  const Assets assets;
  World world = test::make_world({}, assets.set());
  add_tiles(world, assets, kind, 2 * speed + 3, {}, jitter);
  BodyDef def = test::dynamic_body(shape, {}, rounded<Position>(height), 0.13_m);
  def.velocity = {Velocity::from_integer(speed), {}, {}};
  def.material.friction = {};
  return travel(world, test::add(world, def), 120);
}

class Seams : public ::testing::TestWithParam<Tile> {};

INSTANTIATE_TEST_SUITE_P(Tiles, Seams,
                         ::testing::Values(Tile::box, Tile::hull, Tile::compound, Tile::mesh,
                                           Tile::height_field, Tile::mixed));

TEST_P(Seams, DoNotKickABallThatRollsOverThem) {
  for (const int speed : {3, 8, 20}) {
    for (const Length radius : {Length{0.1_m}, Length{0.5_m}}) {
      const Course course = roll(GetParam(), speed, Shape::sphere(radius));
      EXPECT_LT(course.highest, 0.001) << speed;
      EXPECT_NEAR(course.speed, speed, 0.001 * speed);
      EXPECT_TRUE(course.has_room);
    }
  }
}

TEST_P(Seams, DoNotKickACapsuleThatRollsOverThem) {
  for (const int speed : {3, 20}) {
    const Course course = roll(GetParam(), speed, Shape::capsule(0.3_m, 0.2_m));
    EXPECT_LT(course.highest, 0.001) << speed;
    EXPECT_NEAR(course.speed, speed, 0.001 * speed);
  }
}

TEST_P(Seams, DoNotSlowABoxOrAHullThatSlidesOverThem) {
  const Assets assets;
  for (const int speed : {1, 5, 10}) {
    const Course box = slide(GetParam(), speed, Shape::box(0.3_m, 0.2_m, 0.25_m), 0.2_m);
    EXPECT_GT(box.speed, 0.99 * speed);
    EXPECT_LT(box.highest, 0.001);
    const Course hull = slide(GetParam(), speed, assets.brick->shape(), 0.2_m);
    EXPECT_GT(hull.speed, 0.99 * speed);
    EXPECT_LT(hull.highest, 0.001);
  }
}

TEST_P(Seams, AreNotFeltWhereTopsAreTenMicrometresHigherOrLower) {
  const Length jitter = Length::from_ratio(1, 100000);
  for (const int speed : {3, 10}) {
    EXPECT_GT(slide(GetParam(), speed, Shape::box(0.3_m, 0.2_m, 0.25_m), 0.2_m, jitter).speed,
              0.99 * speed);
    EXPECT_LT(roll(GetParam(), speed, Shape::sphere(0.3_m), jitter).highest, 0.001);
  }
}

/// Two tiles, the second one higher, and a body of 0.4 m that comes with 3 m/s.
Course meet_step(Length step, const Shape& shape) {
  World world = test::make_world();
  add_fixed(world, Shape::box(1_m, 0.5_m, 1_m), {-1_m, -0.5_m, {}}, {});
  add_fixed(world, Shape::box(1_m, 0.5_m, 1_m), {1_m, raised(step) - raised(0.5_m), {}}, {});
  BodyDef def = test::dynamic_body(shape, -0.6_m, 0.2_m, {});
  def.velocity.x = 3_mps;
  def.material.friction = {};
  return travel(world, test::add(world, def), 30);
}

TEST(NoSeam, AStepOfAMillimetreIsAStep) {
  for (const Length step : {Length{0.001_m}, Length{0.005_m}, Length{0.05_m}}) {
    EXPECT_LT(meet_step(step, Shape::box(0.2_m, 0.2_m, 0.2_m)).speed, 2);
    EXPECT_LT(meet_step(step, Shape::sphere(0.2_m)).speed, 2.9);
  }
}

TEST(NoSeam, AWallAtTheEndOfAFloorIsAWall) {
  for (const Shape& shape : {Shape::box(0.2_m, 0.2_m, 0.2_m), Shape::sphere(0.2_m)})
    EXPECT_LT(std::abs(meet_step(1_m, shape).speed), 0.01);
}

TEST(NoSeam, ALoneBoxHasASide) {
  World world = test::make_world();
  add_fixed(world, Shape::box(5_m, 0.5_m, 5_m), {{}, -0.5_m, {}}, {});
  add_fixed(world, Shape::box(0.1_m, 0.05_m, 1_m), {1_m, 0.05_m, {}}, {});
  BodyDef def = test::dynamic_body(Shape::box(0.2_m, 0.2_m, 0.2_m), {}, 0.2_m, {});
  def.velocity.x = 2_mps;
  def.material.friction = {};
  const BodyHandle body = test::add(world, def);
  travel(world, body, 60);
  EXPECT_LT(metres(world.body(body).position.x), 0.75);
}

// Each of the two holds the line in which they meet, and neither may be taken for the other.
TEST(NoSeam, ABoardStandsInTheCornerOfFloorAndWall) {
  World world = test::make_world();
  add_fixed(world, Shape::box(2_m, 0.5_m, 2_m), {-2_m, -0.5_m, {}}, {});
  add_fixed(world, Shape::box(0.5_m, 1_m, 2_m), {0.5_m, {}, {}}, {});
  BodyDef def = test::dynamic_body(Shape::box(0.02_m, 0.5_m, 0.3_m), -0.36_m, 0.38_m, {});
  def.orientation = from_axis_angle({{}, {}, 1_r}, 0.7853982_rad);  // its foot in the corner
  def.material.friction = {};
  const BodyHandle body = test::add(world, def);
  for (int i = 0; i < 120; ++i) {
    world.step();
    EXPECT_LT(metres(world.body(body).position.x), -0.019);
    EXPECT_GT(metres(world.body(body).position.y), 0.019);
  }
}

/// Where a box is that tips off the end of a floor of one box or of two side by side.
Vec3<Position> tipped(bool is_parted) {
  World world = test::make_world();
  if (is_parted) {
    add_fixed(world, Shape::box(1_m, 0.5_m, 1_m), {-1_m, -0.5_m, -1_m}, 0.5_r);
    add_fixed(world, Shape::box(1_m, 0.5_m, 1_m), {-1_m, -0.5_m, 1_m}, 0.5_r);
  } else {
    add_fixed(world, Shape::box(1_m, 0.5_m, 2_m), {-1_m, -0.5_m, {}}, 0.5_r);
  }
  const BodyHandle body =
      test::add(world, test::dynamic_body(Shape::box(0.3_m, 0.1_m, 0.2_m), 0.05_m, 0.1_m, 0.05_m));
  travel(world, body, 40);
  return world.body(body).position;
}

TEST(NoSeam, ABoxTipsOffTheEndOfAFloorAcrossASeamAsElsewhere) {
  const Vec3<Position> one = tipped(false), two = tipped(true);
  EXPECT_LT(metres(one.y), -0.2);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(metres(one[i]), metres(two[i]), 0.02);
}

TEST(NoSeam, AreFoundAlikeByAnyNumberOfThreads) {
  const Assets assets;
  std::vector<std::uint64_t> hashes;
  for (const unsigned threads : {1U, 3U}) {
    World world = test::make_world({}, assets.set());
    ThreadPool pool(threads);
    world.set_task_runner(&pool, TaskPieces::smallest);
    add_tiles(world, assets, Tile::mixed, 24, {});
    for (int i = 0; i < 24; ++i) {
      BodyDef def =
          test::dynamic_body(i % 2 == 0 ? Shape::sphere(0.1_m) : Shape::box(0.1_m, 0.1_m, 0.1_m),
                             Position::from_ratio(i, 2), 0.1_m, Position::from_ratio(i % 3 - 1, 2));
      def.velocity.x = 5_mps;
      test::add(world, def);
    }
    test::step(world, 60);
    hashes.push_back(world.hash().total);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// Their difference is 2, which no unit holds.
TEST(Seams, TakeOppositeNormalsForOnesThatDiffer) {
  const Unit one = Unit::from_integer(1);
  EXPECT_TRUE(are_alike({one, {}, {}}, {one, {}, {}}));
  EXPECT_FALSE(are_alike({one, {}, {}}, {-one, {}, {}}));
  EXPECT_FALSE(are_alike({{}, -one, {}}, {{}, one, {}}));
}

}  // namespace
}  // namespace lockstone
