// Bodies that are compounds: frames, contacts part by part, events by pair of bodies.
#include <algorithm>

#include <gtest/gtest.h>

#include <lockstone/compound.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

// Two boxes of 1 m joined 3 m apart, the second three times as heavy.
std::shared_ptr<const Compound> dumbbell() {
  CompoundChild children[2];
  children[0].shape = children[1].shape = Shape::box(0.5_m, 0.5_m, 0.5_m);
  children[1].position = {3_m, {}, {}};
  children[1].density = Number::from_integer(3);
  const CompoundResult built = Compound::build(children);
  EXPECT_TRUE(built.ok());
  return built.compound;
}

World world_with(const AssetPtr& asset) {
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{asset});
  return test::make_world({.body_capacity = 64}, std::move(assets));
}

BodyDef body_of(const Asset& asset, Position y) {
  BodyDef def;
  def.shape = asset.shape();
  def.position = {{}, y, {}};
  return def;
}

TEST(CompoundBody, KeepsItsCentreOfMassInTheWorld) {
  const auto asset = dumbbell();
  World world = world_with(asset);
  BodyDef def = body_of(*asset, {});
  def.position.x = k_world_limit;  // its centre lies farther along x
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
  def.position.x = k_world_limit - 3_m;
  const Result<BodyHandle> body = world.create_body(def);
  ASSERT_TRUE(body.ok());
  const Teleport out{body.value(), {k_world_limit - 1_m, {}, {}}, {}};
  EXPECT_EQ(world.apply(out), Status::invalid_argument);
  EXPECT_EQ(world.position(body.value()).x, def.position.x);
  std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::canonical));
  bytes.resize(world.save(SnapshotKind::canonical, bytes));
  EXPECT_EQ(world.load(SnapshotKind::canonical, bytes), Status::ok);
}

TEST(CompoundBody, IsPlacedByTheFrameOfItsShape) {
  const auto asset = dumbbell();
  World world = world_with(asset);
  const BodyHandle body = test::add(world, body_of(*asset, 5_m));
  const BodyView view = world.body(body);
  EXPECT_EQ(view.position, (Vec3<Position>{{}, 5_m, {}}));
  EXPECT_EQ(view.orientation, Quat{});
  EXPECT_EQ(view.centre_of_mass, (Vec3<Position>{2.25_m, 5_m, {}}));
  EXPECT_NEAR(metres(Position::from_raw(world.mass(body).raw)), 4000, 1e-4);
}

TEST(CompoundBody, RestsOnBothParts) {
  const auto asset = dumbbell();
  World world = world_with(asset);
  test::add_ground(world);
  const BodyHandle body = test::add(world, body_of(*asset, 0.6_m));
  int begins = 0, contacts = 0;
  for (int tick = 0; tick < 240; ++tick) {
    const StepReport report = world.step();
    if (report.asleep_bodies == 0) contacts = static_cast<int>(report.contacts);
    begins += static_cast<int>(
        std::ranges::count(world.events(), EventKind::contact_begin, &ContactEvent::kind));
  }
  EXPECT_EQ(contacts, 2);
  EXPECT_GE(begins, 1);
  EXPECT_LE(begins, 2);  // of the pair of bodies, not of each part
  EXPECT_NEAR(metres(world.position(body).y), 0.5, 2e-3);
  EXPECT_NEAR(metres(world.position(body).x), 0, 1e-3);
  EXPECT_LT(abs(world.body(body).velocity.y), Velocity(0.001_mps));
}

TEST(CompoundBody, FallsOverWhereItsWeightIs) {
  const auto asset = dumbbell();
  World world = world_with(asset);
  BodyDef table;
  table.motion = MotionType::static_body;
  table.shape = Shape::box(1_m, 1_m, 1_m);
  table.position = {0.5_m, -1_m, {}};  // the light end rests on it, the centre of mass does not
  test::add(world, table);
  const BodyHandle body = test::add(world, body_of(*asset, 0.5_m));
  test::step(world, 60);
  EXPECT_LT(metres(world.body(body).centre_of_mass.y), 0);
}

TEST(CompoundBody, IsSeenByQueriesPartByPart) {
  const auto asset = dumbbell();
  World world = world_with(asset);
  const BodyHandle body = test::add(world, body_of(*asset, {}));
  const RayHit second = world.cast_ray({3_m, 4_m, {}}, {{}, -8_m, {}});
  EXPECT_EQ(second.body, body);
  EXPECT_EQ(second.part, 1U);
  EXPECT_NEAR(metres(second.point.y), 0.5, 1e-5);
  EXPECT_TRUE(world.cast_ray({1.5_m, 4_m, {}}, {{}, -8_m, {}}).body.is_null());  // between them
  BodyHandle found[2];
  EXPECT_EQ(world.overlap_sphere({1.5_m, {}, {}}, 0.9_m, found), 0U);
  EXPECT_EQ(world.overlap_sphere({1.5_m, {}, {}}, 1.1_m, found), 1U);
  EXPECT_EQ(world.bodies_at({3.25_m, {}, {}}, found), 1U);
  EXPECT_EQ(world.bodies_at({2.25_m, {}, {}}, found), 0U);  // its centre of mass is in the air
}

TEST(CompoundBody, ComesBackFromACanonicalSnapshotOfTheSameAssetsOnly) {
  const auto asset = dumbbell();
  World world = world_with(asset);
  test::add_ground(world);
  test::add(world, body_of(*asset, 2_m));
  test::step(world, 90);
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  World other = world_with(asset);
  ASSERT_EQ(other.load(SnapshotKind::canonical, saved), Status::ok);
  test::step(world, 60);
  test::step(other, 60);
  EXPECT_EQ(world.hash().total, other.hash().total);
  World without = test::make_world({.body_capacity = 64});
  EXPECT_EQ(without.load(SnapshotKind::canonical, saved), Status::incompatible);
}

TEST(CompoundBody, NeedsAnAssetThatTheWorldKnows) {
  const auto asset = dumbbell();
  World world = test::make_world({.body_capacity = 4});
  EXPECT_EQ(world.create_body(body_of(*asset, {})).status(), Status::not_found);
  World knowing = world_with(asset);
  BodyDef wrong = body_of(*asset, {});
  wrong.shape.kind = ShapeKind::hull;
  EXPECT_EQ(knowing.create_body(wrong).status(), Status::invalid_argument);
}

}  // namespace
}  // namespace lockstone
