// Static bodies of meshes and convex shapes: met as one surface, seen part by part, switched by
// groups.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/character.h>
#include <lockstone/contacts.h>
#include <lockstone/terrain.h>

#include "tests/support/random.h"
#include "tests/support/sample_level.h"
#include "tests/world/terrain/shaken.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

CompoundChild box_at(const Vec3<Length>& position, const Vec3<Length>& half) {
  CompoundChild child;
  child.shape = Shape::box(half.x, half.y, half.z);
  child.position = position;
  return child;
}

// A square of 10 m in y = 0 about its origin, of 50 triangles; the columns of panels along x are
// groups 0 … 4.
AssetPtr floor_mesh(bool grouped) {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  std::vector<std::uint16_t> groups;
  for (int z = 0; z <= 5; ++z)
    for (int x = 0; x <= 5; ++x)
      vertices.push_back({Length::from_integer(2 * x - 5), {}, Length::from_integer(2 * z - 5)});
  for (std::uint32_t i = 0; i < 25; ++i) {
    const std::uint32_t a = i / 5 * 6 + i % 5, b = a + 6;
    triangles.push_back({a, b, b + 1});
    triangles.push_back({a, b + 1, a + 1});
    groups.insert(groups.end(), 2, static_cast<std::uint16_t>(i % 5));
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  if (grouped) def.triangle_groups = groups;
  return Mesh::build(def).mesh;
}

AssetPtr compound_of(std::span<const CompoundChild> children) {
  const CompoundResult built = Compound::build(children);
  EXPECT_TRUE(built.ok()) << to_string(built.fault);
  return built.compound;
}

struct Level {
  AssetPtr asset;
  World world;
  BodyHandle body;

  explicit Level(AssetPtr of, std::uint32_t tiles = 4)
      : asset(std::move(of)),
        world(test::make_world({.body_capacity = 64, .terrain_tile_capacity = tiles},
                               std::make_shared<AssetSet>(std::vector{asset}))) {
    BodyDef def;
    def.motion = MotionType::static_body;
    def.shape = asset->shape();
    body = test::add(world, def);
  }
  BodyHandle drop(const Shape& shape, Position x, Position y, Position z) {
    return test::add(world, test::dynamic_body(shape, x, y, z));
  }
  [[nodiscard]] double height(BodyHandle of) { return metres(world.position(of).y); }
  [[nodiscard]] CompoundPart origin(std::uint32_t part) const {
    return static_cast<const Compound&>(*asset).find_part(part).value_or(CompoundPart{999, 999});
  }
};

void drop_some(Level& level) {
  test::Random random(7);
  for (int i = 0; i < 20; ++i) {
    const Length size = Length::from_ratio(random.between(200, 400), 1000);
    const Position x = Position::from_ratio(random.between(-4000, 4000), 1000);
    const Position z = Position::from_ratio(random.between(-4000, 4000), 1000);
    const Shape shape = i % 3 == 0   ? Shape::sphere(size)
                        : i % 3 == 1 ? Shape::box(size, size / 2, size)
                                     : Shape::capsule(size, size / 2);
    level.drop(shape, x, Position::from_ratio(1000 + 300 * i, 1000), z);
  }
}

// Bodies apart from each other: the numbers of triangles alone differ, which name contact points,
// so that these are solved in another order.
TEST(MeshCompounds, OfOneMeshActAsTheMesh) {
  const std::array<CompoundChild, 1> alone{test::child_of(floor_mesh(false))};
  Level mesh(floor_mesh(false)), compound(compound_of(alone));
  for (Level* level : {&mesh, &compound}) {
    for (int i = 0; i < 16; ++i) {
      const Shape shape = i % 3 == 0   ? Shape::sphere(0.3_m)
                          : i % 3 == 1 ? Shape::box(0.3_m, 0.2_m, 0.4_m)
                                       : Shape::capsule(0.3_m, 0.2_m);
      BodyDef def = test::dynamic_body(shape, Position::from_integer(i % 4 * 2 - 3), 1_m,
                                       Position::from_integer(i / 4 * 2 - 3));
      def.orientation = from_axis_angle({Unit::from_integer(1), {}, {}}, Angle::from_ratio(i, 10));
      test::add(level->world, def);
    }
  }
  for (int tick = 0; tick < 40; ++tick) {
    test::step(mesh.world, 1);
    test::step(compound.world, 1);
    for (std::uint32_t i = 0; i < mesh.world.body_limit(); ++i) {
      const Vec3<Position> gap = mesh.world.position(mesh.world.body_at(i)) -
                                 compound.world.position(compound.world.body_at(i));
      ASSERT_LT(std::abs(metres(gap.x)) + std::abs(metres(gap.y)) + std::abs(metres(gap.z)), 1e-6)
          << tick << " " << i;
    }
  }
}

// The same mesh in two halves and turned, welded where they meet.
TEST(MeshCompounds, AreRolledOverWithoutBumps) {
  const AssetPtr half = floor_mesh(false);
  std::array<CompoundChild, 3> children{test::child_of(half), test::child_of(half, {10_m, {}, {}}),
                                        box_at({-10_m, -1_m, {}}, {5_m, 1_m, 5_m})};
  children[1].orientation = {{}, Unit::from_integer(1), {}, {}};
  for (const Shape& shape :
       {Shape::sphere(0.3_m), Shape::box(0.3_m, 0.3_m, 0.3_m), Shape::capsule(0.3_m, 0.3_m)}) {
    Level level(compound_of(children));
    BodyDef def = test::dynamic_body(shape, -8_m, 0.3_m, 0.37_m);
    if (shape.kind == ShapeKind::capsule) def.position.y = 0.6_m;
    def.velocity = {8_mps, {}, {}};
    def.material.friction = {};
    def.allow_sleep = false;
    def.fixed_rotation = true;
    const BodyHandle runner = test::add(level.world, def);
    const double before = level.height(runner);
    for (int tick = 0; tick < 120; ++tick) {  // 16 m: box, mesh, mesh
      test::step(level.world, 1);
      ASSERT_NEAR(level.height(runner), before, 2e-3) << to_string(shape.kind) << " " << tick;
    }
    EXPECT_NEAR(metres_per_second(level.world.velocity(runner).x), 8, 1e-3);
    EXPECT_GT(metres(level.world.position(runner).x), 7);
  }
}

// The control: where the box is 2 cm higher, its side is met.
TEST(MeshCompounds, HaveStepsWhereChildrenAreNotFlush) {
  const std::array<CompoundChild, 2> children{test::child_of(floor_mesh(false)),
                                              box_at({10_m, -0.98_m, {}}, {5_m, 1_m, 5_m})};
  Level level(compound_of(children));
  BodyDef def = test::dynamic_body(Shape::box(0.3_m, 0.3_m, 0.3_m), 2_m, 0.3_m, {});
  def.velocity = {8_mps, {}, {}};
  def.material.friction = {};
  def.fixed_rotation = true;
  const BodyHandle runner = test::add(level.world, def);
  test::step(level.world, 60);
  EXPECT_LT(metres_per_second(level.world.velocity(runner).x), 1);
}

TEST(MeshCompounds, RestBodiesOnAllTheirParts) {
  const std::array<CompoundChild, 3> children{
      test::child_of(floor_mesh(false)), box_at({3_m, 0.5_m, 3_m}, {1_m, 0.5_m, 1_m}),
      test::child_of(test::sample_hull(), {-4_m, {}, -3_m})};
  Level level(compound_of(children));
  const BodyHandle on_mesh = level.drop(Shape::box(0.3_m, 0.3_m, 0.3_m), {}, 0.5_m, {});
  const BodyHandle on_box = level.drop(Shape::sphere(0.3_m), 3_m, 1.5_m, 3_m);
  const BodyHandle on_hull = level.drop(Shape::box(2_m, 0.1_m, 2_m), -3.4_m, 2_m, -2_m);
  test::step(level.world, 180);
  EXPECT_NEAR(level.height(on_mesh), 0.3, 5e-3);
  EXPECT_NEAR(level.height(on_box), 1.3, 5e-3);
  EXPECT_GT(level.height(on_hull), 0.3);
  std::array<BodyContact, 8> contacts;
  ASSERT_EQ(contacts_of(level.world, on_box, contacts), 1U);
  EXPECT_EQ(level.origin(contacts[0].other_part), (CompoundPart{1, 0}));
  ASSERT_EQ(contacts_of(level.world, on_mesh, contacts), 1U);
  EXPECT_EQ(level.origin(contacts[0].other_part).child, 0U);
}

TEST(MeshCompounds, TellThePartThatIsHit) {
  const std::array<CompoundChild, 3> children{test::child_of(floor_mesh(false)),
                                              box_at({3_m, 0.5_m, 3_m}, {1_m, 0.5_m, 1_m}),
                                              test::child_of(floor_mesh(false), {{}, 4_m, 20_m})};
  Level level(compound_of(children));
  const auto hit_part = [&](Position x, Position y, Position z) {
    BodyDef def = test::dynamic_body(Shape::sphere(0.2_m), x, y, z);
    def.events.hit_speed = SolverVelocity::from_integer(1);
    const BodyHandle ball = test::add(level.world, def);
    for (int tick = 0; tick < 90; ++tick) {
      test::step(level.world, 1);
      for (const HitEvent& hit : hit_events(level.world))
        if (hit.a == ball) return hit.part_b;
    }
    return std::uint32_t{0xffff'ffff};
  };
  EXPECT_EQ(level.origin(hit_part(3_m, 3_m, 3.5_m)), (CompoundPart{1, 0}));
  const RayHit below = level.world.cast_ray({-2.3_m, 1_m, 0.4_m}, {{}, -2_m, {}});
  EXPECT_EQ(hit_part(-2.3_m, 2_m, 0.4_m), below.part);
  EXPECT_EQ(level.origin(below.part).child, 0U);
  EXPECT_EQ(level.origin(hit_part({}, 6_m, 20_m)).child, 2U);
}

// Rays, casts and nearest points against a world where each child is a body of its own.
TEST(MeshCompounds, AreSeenByQueriesAsTheirChildrenAre) {
  const auto children = test::sample_level_children();
  Level level(test::sample_level());
  World apart = test::make_world({.body_capacity = 8},
                                 std::make_shared<AssetSet>(std::vector{test::sample_panels()}));
  for (const CompoundChild& child : children) {
    BodyDef def;
    def.motion = MotionType::static_body;
    def.shape = child.shape;
    for (int axis = 0; axis < 3; ++axis)
      def.position[axis] = rounded<Position>(child.position[axis]);
    def.orientation = child.orientation;
    test::add(apart, def);
  }
  test::Random random(20261127);
  const auto lane = [&](int reach) {
    return Position::from_ratio(random.between(-reach, reach), 1000);
  };
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Position x = lane(5000), y = lane(4000), z = lane(3000);
    const Position dx = lane(6000), dy = lane(6000), dz = lane(3000);
    const Vec3<Position> from{x, y, z};
    const Vec3<Length> way{saturated<Length>(dx), saturated<Length>(dy), saturated<Length>(dz)};
    const RayHit one = level.world.cast_ray(from, way), other = apart.cast_ray(from, way);
    ASSERT_EQ(one.body.is_null(), other.body.is_null()) << i;
    const ShapeCast cast{Shape::box(0.2_m, 0.1_m, 0.3_m), {from, {}}, way};
    const ShapeHit met = level.world.cast_shape(cast), met_apart = apart.cast_shape(cast);
    ASSERT_EQ(met.body.is_null(), met_apart.body.is_null()) << i;
    const auto near = level.world.closest_point(from, 2_m),
               near_apart = apart.closest_point(from, 2_m);
    ASSERT_EQ(near.body.is_null(), near_apart.body.is_null()) << i;
    EXPECT_NEAR(near.distance.raw, near_apart.distance.raw, 8) << i;
    if (one.body.is_null()) continue;
    ++hits;
    EXPECT_NEAR(one.fraction.raw, other.fraction.raw, 2000) << i;  // 2 µm of a way of up to 9 m
    EXPECT_EQ(level.origin(one.part).child, other.body.index) << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(MeshCompounds, StopFastAndThinBodies) {
  const std::array<CompoundChild, 2> children{test::child_of(floor_mesh(false)),
                                              box_at({10_m, -1_m, {}}, {5_m, 1_m, 5_m})};
  for (const Shape& shape : {Shape::sphere(0.02_m), Shape::box(0.3_m, 0.001_m, 0.3_m)}) {
    for (const Position x : {Position{1.3_m}, Position{10.3_m}}) {
      Level level(compound_of(children));
      BodyDef def = test::dynamic_body(shape, x, 3_m, 0.4_m);
      def.velocity = {{}, -300_mps, {}};
      const BodyHandle body = test::add(level.world, def);
      test::step(level.world, 30);
      EXPECT_GT(level.height(body), -0.05) << to_string(shape.kind) << " " << metres(x);
    }
  }
}

TEST(MeshCompounds, AreNotForDynamicBodies) {
  Level level(test::sample_level());
  BodyDef def;
  def.shape = level.asset->shape();
  EXPECT_EQ(level.world.create_body(def).status(), Status::invalid_argument);
  EXPECT_EQ(level.world.explain(def).field, "body.motion");
  const SetMotionType falls{level.body, MotionType::dynamic};
  EXPECT_EQ(level.world.apply(falls), Status::invalid_argument);
  EXPECT_EQ(level.world.apply(SetMotionType{level.body, MotionType::kinematic}), Status::ok);
  const BodyHandle crate = level.drop(Shape::sphere(0.2_m), {}, 1_m, {});
  EXPECT_EQ(level.world.apply(SetShape{crate, def.shape}), Status::invalid_argument);
}

TEST(MeshCompounds, AreZonesThatSeeBodiesAtTheirParts) {
  Level level(test::sample_level());
  BodyDef zone;
  zone.motion = MotionType::static_body;
  zone.shape = level.asset->shape();
  zone.position = {{}, 20_m, {}};
  zone.is_trigger = true;
  test::add(level.world, zone);
  level.drop(Shape::sphere(0.2_m), 3.4_m, 21_m, 0.4_m);
  int enters = 0;
  for (int tick = 0; tick < 60; ++tick) {
    test::step(level.world, 1);
    enters += static_cast<int>(
        std::ranges::count(level.world.events(), EventKind::trigger_enter, &ContactEvent::kind));
  }
  EXPECT_EQ(enters, 1);
}

TEST(MeshCompounds, AreWalkedOn) {
  const std::array<CompoundChild, 2> children{test::child_of(floor_mesh(false)),
                                              box_at({10_m, -1_m, {}}, {5_m, 1_m, 5_m})};
  Level level(compound_of(children));
  CharacterDef def;
  Vec3<Position> at{-3_m, 1_m, 0.3_m};
  for (int tick = 0; tick < 200; ++tick)
    at = move_character(level.world, def, at, {0.08_m, -0.02_m, {}}, tick > 20).position;
  const double height = metres(at.y);
  EXPECT_GT(metres(at.x), 9);
  EXPECT_GT(height, 0.5);
  EXPECT_LT(height, 1.1);
}

// The panels of one number in both meshes go together.
TEST(MeshCompounds, SwitchTheGroupsOfAllTheirMeshes) {
  const std::array<CompoundChild, 4> children{
      test::child_of(floor_mesh(true)), test::child_of(floor_mesh(true), {{}, {}, 12_m}),
      box_at({{}, -1_m, 6_m}, {5_m, 1_m, 1_m}), test::child_of(floor_mesh(false), {10_m, {}, {}})};
  Level level(compound_of(children));
  const auto blocked = [&](Position x, Position z) {
    return level.world.is_ray_blocked({x, 2_m, z}, {{}, -4_m, {}});
  };
  const BodyHandle crate = level.drop(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
  const BodyHandle beside = level.drop(Shape::box(0.5_m, 0.5_m, 0.5_m), 4_m, 0.5_m, {});
  test::step(level.world, 120);
  ASSERT_TRUE(level.world.body(crate).is_asleep);
  const std::uint64_t before = level.world.hash().total;
  ASSERT_EQ(level.world.apply(SetMeshGroup{level.body, 2, false}), Status::ok);
  EXPECT_FALSE(level.world.body(crate).is_asleep);
  EXPECT_TRUE(level.world.body(beside).is_asleep);
  EXPECT_FALSE(blocked(0.8_m, 0.1_m));
  EXPECT_FALSE(blocked(0.8_m, 12.1_m));
  EXPECT_TRUE(blocked(0.8_m, 6.1_m));  // the box stays
  ASSERT_EQ(level.world.apply(SetMeshGroup{level.body, 0, false}), Status::ok);
  EXPECT_FALSE(blocked(-4_m, 0.1_m));
  EXPECT_TRUE(blocked(10_m, 0.1_m));  // and the mesh without groups
  ASSERT_EQ(level.world.apply(SetMeshGroup{level.body, 0, true}), Status::ok);
  EXPECT_TRUE(blocked(2.2_m, 0.1_m));
  EXPECT_EQ(is_mesh_group_on(level.world, level.body, 2), false);
  for (const std::uint32_t none : {5U, 0xffffU})
    EXPECT_EQ(level.world.apply(SetMeshGroup{level.body, none, false}), Status::invalid_argument);
  EXPECT_NE(level.world.hash().total, before);
  test::step(level.world, 60);
  EXPECT_LT(level.height(crate), -3);
  EXPECT_NEAR(level.height(beside), 0.5, 0.01);
  ASSERT_EQ(level.world.apply(SetMeshGroup{level.body, 2, true}), Status::ok);
  EXPECT_TRUE(blocked(0.8_m, 12.1_m));
}

TEST(MeshCompounds, OfMeshesWithoutGroupsHaveNoneToSwitch) {
  const std::array<CompoundChild, 1> children{test::child_of(floor_mesh(false))};
  Level level(compound_of(children));
  EXPECT_EQ(level.world.apply(SetMeshGroup{level.body, 0, false}), Status::not_found);
}

struct ShakenLevel : Level {
  ShakenLevel()
      : Level(compound_of(std::array{test::child_of(floor_mesh(true)),
                                     box_at({7_m, -0.9_m, {}}, {2_m, 1_m, 5_m}),
                                     test::child_of(test::sample_hull(), {-3_m, {}, -3_m})})) {
    drop_some(*this);
  }
  [[nodiscard]] Status set(std::uint32_t group, bool is_on) {
    return world.apply(SetMeshGroup{body, group, is_on});
  }
  void shake(int tick) {
    test::Random random(static_cast<std::uint64_t>(tick));
    const auto group = static_cast<std::uint32_t>(random.below(5));
    const bool is_on = random.below(2) == 0;
    ASSERT_EQ(set(group, is_on), Status::ok);
  }
};

TEST(MeshCompounds, GoOnFromASnapshot) {
  test::expect_goes_on_from_snapshots<ShakenLevel>();
}

TEST(MeshCompounds, AreRolledBack) {
  test::expect_is_rolled_back<ShakenLevel>();
}

}  // namespace
}  // namespace lockstone
