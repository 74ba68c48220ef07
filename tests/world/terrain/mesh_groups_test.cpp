// Groups of a mesh that a world switches off and on.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/character.h>
#include <lockstone/mesh.h>
#include <lockstone/terrain.h>

#include "tests/support/random.h"
#include "tests/world/terrain/shaken.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

constexpr std::uint32_t k_side = 5;  // panels of 2 m, from −5 to 5 m

// A floor of panels, each a group, or without some of them: each is two triangles in y = 0.
AssetPtr floor_without(const std::vector<std::uint32_t>& missing, bool grouped) {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  std::vector<std::uint16_t> groups;
  for (std::uint32_t z = 0; z <= k_side; ++z) {
    for (std::uint32_t x = 0; x <= k_side; ++x)
      vertices.push_back({Length::from_integer(2 * static_cast<int>(x) - 5),
                          {},
                          Length::from_integer(2 * static_cast<int>(z) - 5)});
  }
  for (std::uint32_t i = 0; i < k_side * k_side; ++i) {
    if (std::ranges::find(missing, i) != missing.end()) continue;
    const std::uint32_t a = i / k_side * (k_side + 1) + i % k_side, b = a + k_side + 1;
    triangles.push_back({a, b, b + 1});
    triangles.push_back({a, b + 1, a + 1});
    groups.insert(groups.end(), 2, static_cast<std::uint16_t>(i));
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  if (grouped) def.triangle_groups = groups;
  return Mesh::build(def).mesh;
}

struct Floor {
  AssetPtr asset;
  World world;
  BodyHandle floor;

  explicit Floor(AssetPtr mesh = floor_without({}, true), std::uint32_t tiles = 4)
      : asset(std::move(mesh)),
        world(test::make_world({.body_capacity = 32, .terrain_tile_capacity = tiles},
                               std::make_shared<AssetSet>(std::vector{asset}))) {
    BodyDef def;
    def.motion = MotionType::static_body;
    def.shape = asset->shape();
    floor = test::add(world, def);
  }
  [[nodiscard]] Status set(std::uint32_t group, bool is_on) {
    return world.apply(SetMeshGroup{floor, group, is_on});
  }
  BodyHandle drop(const Shape& shape, Position x, Position y, Position z) {
    return test::add(world, test::dynamic_body(shape, x, y, z));
  }
  [[nodiscard]] double height(BodyHandle body) { return metres(world.position(body).y); }
  [[nodiscard]] bool ray(Position x, Position z) const {
    return world.is_ray_blocked({x, 2_m, z}, {{}, -4_m, {}});
  }
};

const Shape k_crate = Shape::box(0.5_m, 0.5_m, 0.5_m);

// The middle panel is group 12.
TEST(MeshGroups, LetFallTheBodiesOnThem) {
  Floor on;
  const BodyHandle crate = on.drop(k_crate, {}, 0.5_m, {});
  const BodyHandle beside = on.drop(k_crate, 4_m, 0.5_m, {});
  test::step(on.world, 120);
  ASSERT_TRUE(on.world.body(crate).is_asleep && on.world.body(beside).is_asleep);
  ASSERT_EQ(on.set(12, false), Status::ok);
  EXPECT_FALSE(on.world.body(crate).is_asleep);
  EXPECT_TRUE(on.world.body(beside).is_asleep);
  test::step(on.world, 60);
  EXPECT_LT(on.height(crate), -3);
  EXPECT_NEAR(on.height(beside), 0.5, 0.01);
  EXPECT_EQ(is_mesh_group_on(on.world, on.floor, 12), false);
  EXPECT_EQ(is_mesh_group_on(on.world, on.floor, 13), true);
}

TEST(MeshGroups, BearAgainOnceTheyAreOn) {
  Floor floor;
  const std::uint64_t before = floor.world.hash().total;
  ASSERT_EQ(floor.set(12, false), Status::ok);
  EXPECT_NE(floor.world.hash().total, before);
  EXPECT_EQ(terrain_tile_count(floor.world), 1U);
  ASSERT_EQ(floor.set(12, true), Status::ok);
  EXPECT_EQ(floor.world.hash().total, before);
  EXPECT_EQ(terrain_tile_count(floor.world), 0U);
  const BodyHandle crate = floor.drop(k_crate, {}, 0.6_m, {});
  test::step(floor.world, 120);
  EXPECT_NEAR(floor.height(crate), 0.5, 0.01);
}

TEST(MeshGroups, AreNotSeenByQueriesWhileTheyAreOff) {
  Floor floor;
  const ShapeCast ball{Shape::sphere(0.3_m), {{0_m, 2_m, 0_m}, {}}, {{}, -4_m, {}}};
  const auto closest = [&] {
    return !floor.world.closest_point({0_m, 0.5_m, 0_m}, 0.7_m).body.is_null();
  };
  const auto cast = [&] { return !floor.world.cast_shape(ball).body.is_null(); };
  EXPECT_TRUE(floor.ray(0.2_m, 0.1_m));
  EXPECT_TRUE(cast());
  EXPECT_TRUE(closest());
  ASSERT_EQ(floor.set(12, false), Status::ok);
  EXPECT_FALSE(floor.ray(0.2_m, 0.1_m));
  EXPECT_TRUE(floor.ray(2.2_m, 0.1_m));
  EXPECT_FALSE(cast());
  EXPECT_FALSE(closest());
}

TEST(MeshGroups, AreNoGroundForCharactersWhileTheyAreOff) {
  Floor floor;
  const auto falls = [&] {
    CharacterDef def;
    return metres(
        move_character(floor.world, def, {0_m, 0.95_m, 0_m}, {{}, -0.5_m, {}}, false).position.y);
  };
  const double stands = falls();
  ASSERT_EQ(floor.set(12, false), Status::ok);
  EXPECT_LT(falls(), stands - 0.1);
}

TEST(MeshGroups, DoNotStopFastBodiesWhileTheyAreOff) {
  for (const bool is_on : {true, false}) {
    Floor floor;
    ASSERT_EQ(floor.set(12, is_on), Status::ok);
    BodyDef def = test::dynamic_body(Shape::sphere(0.05_m), 0.3_m, 3_m, 0.2_m);
    def.velocity = {{}, -400_mps, {}};
    const BodyHandle bullet = test::add(floor.world, def);
    test::step(floor.world, 2);
    EXPECT_EQ(floor.height(bullet) > -0.1, is_on);
  }
}

// As the same floor made without the panels: balls that fall over the rims of holes.
TEST(MeshGroups, LeaveHolesWithTheRimsOfAMeshWithoutThem) {
  test::Random random(20261126);
  const std::vector<std::uint32_t> holes{12, 7, 3};
  int rims = 0;
  for (int i = 0; i < 120; ++i) {
    Floor edited, made(floor_without(holes, false));
    for (const std::uint32_t hole : holes)
      ASSERT_EQ(edited.set(hole, false), Status::ok);
    const Position x = Position::from_ratio(random.between(-1300, 1300), 1000);
    const Position z = Position::from_ratio(random.between(-3300, 1300), 1000);
    const Shape shape = i % 2 == 0 ? Shape::sphere(0.4_m) : Shape::capsule(0.4_m, 0.2_m);
    const BodyHandle one = edited.drop(shape, x, 1_m, z), other = made.drop(shape, x, 1_m, z);
    for (int tick = 0; tick < 90; ++tick) {
      (void)edited.world.step();
      (void)made.world.step();
      const Vec3<Position> gap = edited.world.position(one) - made.world.position(other);
      ASSERT_LT(std::abs(metres(gap.x)) + std::abs(metres(gap.y)) + std::abs(metres(gap.z)), 1e-3)
          << "case " << i << ", tick " << tick;
    }
    const Vec3<Position> at = made.world.position(other);
    if (metres(at.y) < -1 && (at.x != x || at.z != z)) ++rims;
  }
  EXPECT_GT(rims, 5);  // the control: some were pushed aside by a rim
}

// Groups that are on have no seams.
TEST(MeshGroups, AreOneSurfaceWhileTheyAreOn) {
  Floor grouped, plain(floor_without({}, false));
  EXPECT_NE(grouped.asset->id(), plain.asset->id());
  std::array<BodyHandle, 2> balls;
  for (int i = 0; i < 2; ++i) {
    Floor& floor = i == 0 ? grouped : plain;
    BodyDef def = test::dynamic_body(Shape::sphere(0.3_m), -4.5_m, 0.3_m, 0.13_m);
    def.velocity = {5_mps, {}, 0.4_mps};
    balls[static_cast<std::size_t>(i)] = test::add(floor.world, def);
    test::step(floor.world, 90);
  }
  EXPECT_EQ(grouped.world.position(balls[0]), plain.world.position(balls[1]));
  EXPECT_NEAR(grouped.height(balls[0]), 0.3, 1e-3);
}

TEST(MeshGroups, OfOneNumberAreNone) {
  std::vector<Vec3<Length>> vertices{{}, {{}, {}, 1_m}, {1_m, {}, {}}};
  const std::vector<TriangleIndices> triangles{{0, 1, 2}};
  const std::vector<std::uint16_t> zero{0}, beyond{k_max_mesh_groups};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  const AssetId plain = Mesh::build(def).mesh->id();
  def.triangle_groups = zero;
  EXPECT_EQ(Mesh::build(def).mesh->id(), plain);
  def.triangle_groups = beyond;
  EXPECT_EQ(Mesh::build(def).fault, MeshFault::group_out_of_range);
  Floor floor(floor_without({}, false));
  EXPECT_EQ(floor.set(0, false), Status::not_found);
}

TEST(MeshGroups, ComeBackFromTheBytesOfTheirMesh) {
  const AssetPtr asset = floor_without({}, true);
  const auto loaded = Mesh::from_bytes(asset->canonical_bytes());
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded.value()->id(), asset->id());
  Floor floor(loaded.value());
  ASSERT_EQ(floor.set(12, false), Status::ok);
  EXPECT_FALSE(floor.ray(0.2_m, 0.1_m));
}

TEST(MeshGroups, AreRefusedWithTheReason) {
  Floor floor(floor_without({}, true), 1);
  const auto refused = [&](const SetMeshGroup& command, Status status) {
    EXPECT_EQ(floor.world.apply(command), status);
    return floor.world.explain(command).field;
  };
  EXPECT_EQ(refused({floor.floor, 25, false}, Status::invalid_argument), "SetMeshGroup.group");
  EXPECT_EQ(refused({floor.floor, 1U << 31, false}, Status::invalid_argument),
            "SetMeshGroup.group");
  const BodyHandle crate = floor.drop(k_crate, {}, 2_m, {});
  EXPECT_EQ(refused({crate, 0, false}, Status::not_found), "SetMeshGroup.body");
  ASSERT_EQ(floor.set(3, false), Status::ok);
  ASSERT_EQ(floor.set(4, false), Status::ok);  // the same tile
  EXPECT_EQ(refused({floor.floor, 20, false}, Status::capacity_exhausted), "SetMeshGroup.group");
}

// A floor of crates whose groups are switched by chance, the same in each tick.
struct Shaken : Floor {
  Shaken() {
    for (int i = 0; i < 12; ++i)
      drop(k_crate, Position::from_integer(i % 4 * 2 - 3), Position::from_integer(1 + i / 4),
           Position::from_integer(i / 4 * 2 - 2));
  }
  void shake(int tick) {
    test::Random random(static_cast<std::uint64_t>(tick));
    const auto group = static_cast<std::uint32_t>(random.below(25));
    ASSERT_EQ(set(group, random.below(2) == 0), Status::ok);
  }
};

TEST(MeshGroups, GoOnFromASnapshot) {
  test::expect_goes_on_from_snapshots<Shaken>();
}

TEST(MeshGroups, AreRolledBack) {
  test::expect_is_rolled_back<Shaken>();
}

TEST(MeshGroups, GoWithABodyThatIsTeleported) {
  Floor floor;
  ASSERT_EQ(floor.set(12, false), Status::ok);
  ASSERT_EQ(floor.world.apply(Teleport{floor.floor, {2_m, 1_m, {}}, {}}), Status::ok);
  const BodyHandle through = floor.drop(k_crate, 2_m, 2_m, {}),
                   carried = floor.drop(k_crate, {}, 2_m, {});
  test::step(floor.world, 120);
  EXPECT_LT(floor.height(through), 0);
  EXPECT_NEAR(floor.height(carried), 1.5, 0.02);
}

}  // namespace
}  // namespace lockstone
