// Meshes on kinematic bodies: platforms, ships, doors of triangles.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/rollback_history.h>
#include <lockstone/terrain.h>
#include <lockstone/thread_pool.h>

#include "tests/world/flat_terrain.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

// A deck that moves, or a box whose top does.
struct Ship {
  AssetPtr asset = test::flat_mesh();
  World world;
  BodyHandle deck;

  explicit Ship(bool of_triangles = true, BodyDef motion = {}, bool cargo_first = false)
      : world(test::make_world(
            {.body_capacity = 32, .joint_capacity = 1, .sleep_ms = 0, .terrain_tile_capacity = 4},
            std::make_shared<AssetSet>(std::vector{asset}))) {
    if (cargo_first) load();
    motion.motion = MotionType::kinematic;
    motion.shape = of_triangles ? asset->shape() : Shape::box(3_m, 0.5_m, 3_m);
    if (!of_triangles) motion.position.y = motion.position.y - 0.5_m;
    deck = test::add(world, motion);
    if (!cargo_first) load();
  }
  void load() {
    BodyDef def = test::dynamic_body(Shape::box(0.3_m, 0.3_m, 0.3_m), 2_m, 0.3_m, 0.4_m);
    def.material.friction = 1_r;
    crate = test::add(world, def);
    ball = test::add(world, test::dynamic_body(Shape::sphere(0.3_m), {}, 0.3_m, {}));
  }
  BodyHandle crate, ball;
};

BodyDef moving(Velocity x, Velocity y, AngularVelocity turning = {}) {
  BodyDef def;
  def.velocity = {x, y, {}};
  def.angular_velocity.y = turning;
  return def;
}

TEST(KinematicMeshes, CarryBodiesUp) {
  for (const bool cargo_first : {false, true}) {
    Ship ship(true, moving({}, 1_mps), cargo_first);
    test::step(ship.world, 120);
    EXPECT_NEAR(metres(ship.world.position(ship.crate).y), 2.3, 2e-3);
    EXPECT_NEAR(metres(ship.world.position(ship.ball).y), 2.3, 2e-3);
    EXPECT_NEAR(metres_per_second(ship.world.velocity(ship.crate).y), 1, 1e-3);
    EXPECT_FALSE(ship.world.find_fault());
  }
}

TEST(KinematicMeshes, CarryBodiesAlongAsBoxesDo) {
  Ship mesh(true, moving(2_mps, {})), box(false, moving(2_mps, {}));
  test::step(mesh.world, 180);
  test::step(box.world, 180);
  EXPECT_NEAR(metres(mesh.world.position(mesh.crate).x), metres(box.world.position(box.crate).x),
              5e-3);
  EXPECT_NEAR(metres_per_second(mesh.world.velocity(mesh.crate).x), 2, 1e-3);
}

TEST(KinematicMeshes, TurnBodiesAsBoxesDo) {
  Ship mesh(true, moving({}, {}, 1_rps)), box(false, moving({}, {}, 1_rps));
  EXPECT_EQ(mesh.world.body(mesh.deck).angular_velocity.y, 1_rps);
  test::step(mesh.world, 180);
  test::step(box.world, 180);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(metres(mesh.world.position(mesh.crate)[axis]),
                metres(box.world.position(box.crate)[axis]), 0.02);
  EXPECT_FALSE(mesh.world.find_fault());
}

TEST(KinematicMeshes, AreFlatForBodiesThatSlideOnThem) {
  Ship ship(true, moving(3_mps, {}));
  BodyDef def = test::dynamic_body(Shape::box(0.3_m, 0.3_m, 0.3_m), -2.5_m, 0.3_m, -2.1_m);
  def.material.friction = {};
  def.velocity = {5_mps, {}, 0.3_mps};
  const BodyHandle slider = test::add(ship.world, def);
  for (int tick = 0; tick < 120; ++tick) {
    test::step(ship.world, 1);
    EXPECT_NEAR(metres(ship.world.position(slider).y), 0.3, 1e-3);
  }
  EXPECT_NEAR(metres_per_second(ship.world.velocity(slider).x), 5, 1e-3);
}

TEST(KinematicMeshes, StopFastBodies) {
  Ship ship(true, moving(1_mps, 1_mps));
  BodyDef def = test::dynamic_body(Shape::sphere(0.05_m), -2.3_m, 10_m, 1.2_m);
  def.velocity.y = -300_mps;
  const BodyHandle shot = test::add(ship.world, def);
  test::step(ship.world, 30);
  EXPECT_GT(metres(ship.world.position(shot).y), 0.5);
}

TEST(KinematicMeshes, AreMovedByCommands) {
  Ship ship;
  for (int tick = 1; tick <= 60; ++tick) {
    const Position height = Position::from_ratio(tick, 60);
    ASSERT_EQ(ship.world.apply(MoveKinematic{ship.deck, {{}, height, {}}, {}}), Status::ok);
    test::step(ship.world, 1);
  }
  EXPECT_NEAR(metres(ship.world.position(ship.crate).y), 1.3, 2e-3);
}

TEST(KinematicMeshes, ChangeMotionAndShape) {
  Ship ship(true, moving({}, {}, 1_rps));
  World& world = ship.world;
  test::step(world, 30);
  ASSERT_EQ(world.apply(SetMotionType{ship.deck, MotionType::static_body, {}}), Status::ok);
  EXPECT_FALSE(world.find_fault());
  test::step(world, 30);
  EXPECT_NEAR(metres(world.position(ship.crate).y), 0.3, 2e-3);
  EXPECT_EQ(world.apply(SetMotionType{ship.deck, MotionType::dynamic, {}}),
            Status::invalid_argument);
  ASSERT_EQ(world.apply(SetMotionType{ship.deck, MotionType::kinematic, {}}), Status::ok);
  ASSERT_EQ(world.apply(SetAngularVelocity{ship.deck, {{}, 5_rps, {}}}), Status::ok);
  EXPECT_EQ(world.body(ship.deck).angular_velocity.y, 5_rps);
  EXPECT_FALSE(world.find_fault());
  test::step(world, 5);
  for (const Shape& shape : {Shape::box(3_m, 0.5_m, 3_m), ship.asset->shape()}) {
    ASSERT_EQ(world.apply(SetShape{ship.deck, shape, {}}), Status::ok);
    EXPECT_FALSE(world.find_fault());
    test::step(world, 5);
    EXPECT_FALSE(world.find_fault());
  }
}

// The order of two bodies in a pair follows from their shapes. A joint whose pair stood in the old
// order let its bodies collide until the world was loaded, and broke the list when it went.
TEST(KinematicMeshes, TouchNoBodyThatIsJoinedToThemInAnyShape) {
  Ship ship, dropping;
  for (Ship* one : {&ship, &dropping}) {
    JointDef def = JointDef::of(JointKind::slider, one->deck, one->crate);
    def.frame_a.position = {2_m, 0.3_m, 0.4_m};
    ASSERT_TRUE(one->world.create_joint(def).ok());
  }
  for (const Shape& shape :
       {Shape::box(3_m, 0.5_m, 3_m), ship.asset->shape(), Shape::box(2_m, 0.5_m, 2_m)}) {
    for (Ship* one : {&ship, &dropping}) {
      ASSERT_EQ(one->world.apply(SetShape{one->deck, shape, {}}), Status::ok);
      test::step(one->world, 5);
      EXPECT_FALSE(one->world.touching(one->deck, one->crate));
    }
    dropping.world.drop_derived();
    EXPECT_FALSE(ship.world.find_fault());
    EXPECT_EQ(ship.world.hash().total, dropping.world.hash().total);
  }
  for (std::uint32_t i = 0; i < ship.world.joint_limit(); ++i)
    ASSERT_EQ(ship.world.apply(DestroyJoint{ship.world.joint_at(i)}), Status::ok);
  EXPECT_FALSE(ship.world.find_fault());
}

TEST(KinematicMeshes, AreNeitherDynamicNorHeightFields) {
  Ship ship;
  BodyDef def;
  def.shape = ship.asset->shape();
  EXPECT_EQ(ship.world.create_body(def).status(), Status::invalid_argument);
  EXPECT_EQ(ship.world.explain(def).field, "body.motion");
  EXPECT_EQ(ship.world.apply(SetShape{ship.crate, def.shape}), Status::invalid_argument);
  const AssetPtr field = test::level_field();
  World world = test::make_world({}, std::make_shared<AssetSet>(std::vector{field}));
  def.shape = field->shape();
  def.motion = MotionType::kinematic;
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
  EXPECT_EQ(world.explain(def).field, "body.motion");
}

// The same whatever steps the world, saved and loaded in every tick.
TEST(KinematicMeshes, AreTheSameOnEveryPath) {
  const BodyDef motion = moving(1_mps, 0.2_mps, 2_rps);
  Ship plain(true, motion), dropping(true, motion), loaded(true, motion), shared(true, motion);
  Ship rolled(true, motion);
  ThreadPool pool(3);
  shared.world.set_task_runner(&pool, TaskPieces::smallest);
  RollbackHistory history(rolled.world, 8);
  for (int tick = 0; tick < 120; ++tick) {
    const std::vector<std::byte> before = test::save(rolled.world, SnapshotKind::native);
    (void)rolled.world.apply(ApplyImpulse{rolled.ball, {{}, 300_Ns, {}}});
    (void)history.step();
    (void)history.step();
    ASSERT_EQ(rolled.world.load(SnapshotKind::native, before), Status::ok);
    (void)history.step();
    dropping.world.drop_derived();
    const std::vector<std::byte> canonical = test::save(plain.world, SnapshotKind::canonical);
    ASSERT_EQ(loaded.world.load(SnapshotKind::canonical, canonical), Status::ok);
    ASSERT_FALSE(loaded.world.find_fault());
    for (Ship* ship : {&plain, &dropping, &loaded, &shared})
      test::step(ship->world, 1);
    for (const Ship* ship : {&dropping, &loaded, &shared, &rolled})
      ASSERT_EQ(plain.world.hash().total, ship->world.hash().total) << tick;
  }
}

}  // namespace
}  // namespace lockstone
