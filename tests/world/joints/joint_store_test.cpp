// Joints as state: handles, refusals, snapshots, and bodies that no longer collide.

#include <cstring>

#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "core/dynamics/state/joint_record.h"
#include "core/world/state/world_header.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

const WorldDef k_def{.body_capacity = 8};

struct HungBall {
  World world = test::make_world(k_def);
  BodyHandle anchor = test::add(world, fixed());
  BodyHandle bob = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 1_m, {}, {}));

  [[nodiscard]] static BodyDef fixed() {
    BodyDef def;
    def.motion = MotionType::static_body;
    return def;
  }
  [[nodiscard]] JointDef ball() const {
    JointDef def = JointDef::of(JointKind::ball, anchor, bob);
    def.frame_b.position = {-1_m, {}, {}};
    return def;
  }
};

TEST(JointStore, HandlesOfDestroyedJointsNameNothing) {
  HungBall p;
  const JointHandle first = p.world.create_joint(p.ball()).value();
  EXPECT_TRUE(p.world.exists(first));
  EXPECT_EQ(p.world.joint_count(), 1U);
  ASSERT_EQ(p.world.apply(DestroyJoint{first}), Status::ok);
  EXPECT_FALSE(p.world.exists(first));
  EXPECT_EQ(p.world.apply(DestroyJoint{first}), Status::stale_handle);
  const JointHandle second = p.world.create_joint(p.ball()).value();
  EXPECT_EQ(second.index, first.index);
  EXPECT_NE(second.generation, first.generation);
  EXPECT_FALSE(p.world.exists(first));
}

TEST(JointStore, DestroyingABodyDestroysItsJoints) {
  HungBall p;
  const JointHandle joint = p.world.create_joint(p.ball()).value();
  ASSERT_EQ(p.world.apply(DestroyBody{p.anchor}), Status::ok);
  EXPECT_FALSE(p.world.exists(joint));
  EXPECT_EQ(p.world.joint_count(), 0U);
}

TEST(JointStore, RefusesImpossibleJoints) {
  HungBall p;
  const BodyHandle other = test::add(p.world, HungBall::fixed());
  const auto refused = [&](auto&& change, Status status = Status::invalid_argument) {
    JointDef def = p.ball();
    change(def);
    EXPECT_EQ(p.world.create_joint(def).status(), status);
  };
  refused([](JointDef& def) {
    def.kind = static_cast<JointKind>(static_cast<int>(k_last_joint_kind) + 1);
  });
  refused([](JointDef& def) { def.kind = {}; });
  refused([](JointDef& def) { def.body_a = def.body_b; });
  refused([&](JointDef& def) { def.body_b = other; });
  refused([](JointDef& def) { def.frame_b.position.x = 65_m; });
  refused([](JointDef& def) { def.frame_a.orientation = {{}, {}, {}, {}}; });
  refused([](JointDef& def) { def.angular[0].lower = 4_rad; });
  refused([](JointDef& def) { def.linear[1].hertz = -1_r; });
  refused([](JointDef& def) { def.linear[1].max_effort = -1_N; });
  refused([](JointDef& def) { def.break_force = -1_N; });
  refused([](JointDef& def) { def.body_a.generation += 1; }, Status::stale_handle);
  EXPECT_EQ(p.world.joint_count(), 0U);
}

TEST(JointStore, RefusesToLetABodyTurnThatHangsTooFarAway) {
  HungBall p;
  const AxisLocks upright{.turn_x = true, .turn_y = true, .turn_z = true};
  JointDef far = p.ball();
  far.frame_b.position = {-200_m, {}, {}};
  EXPECT_FALSE(p.world.create_joint(far).ok());
  ASSERT_EQ(p.world.apply(SetAxisLocks{p.bob, upright}), Status::ok);
  const JointHandle joint = p.world.create_joint(far).value();
  EXPECT_EQ(p.world.apply(SetAxisLocks{p.bob, {}}), Status::invalid_argument);
  ASSERT_EQ(p.world.apply(DestroyJoint{joint}), Status::ok);
  EXPECT_EQ(p.world.apply(SetAxisLocks{p.bob, {}}), Status::ok);
}

TEST(JointStore, IsFullAtItsCapacity) {
  World world = test::make_world(
      {.body_capacity = 2, .pair_capacity = 8, .contact_capacity = 8, .joint_capacity = 1});
  const BodyHandle a = test::add(world, {}), b = test::add(world, {});
  const JointDef def = JointDef::of(JointKind::weld, a, b);
  ASSERT_TRUE(world.create_joint(def).ok());
  EXPECT_EQ(world.create_joint(def).status(), Status::capacity_exhausted);
}

TEST(JointStore, NewSettingsAreCheckedAndKept) {
  HungBall p;
  const JointHandle joint = p.world.create_joint(p.ball()).value();
  AngularAxis axis;
  axis.speed = 2_rps;
  const std::uint64_t before = p.world.hash().joints;
  EXPECT_EQ(p.world.apply(SetAngularAxis{joint, 0, axis}), Status::ok);
  EXPECT_NE(p.world.hash().joints, before);
  EXPECT_EQ(p.world.apply(SetAngularAxis{joint, 3, axis}), Status::invalid_argument);
  axis.lower = 1_rad;
  EXPECT_EQ(p.world.apply(SetAngularAxis{joint, 0, axis}), Status::invalid_argument);
  EXPECT_EQ(p.world.apply(SetLinearAxis{{7, 1}, 0, {}}), Status::stale_handle);
}

TEST(JointStore, JoinedBodiesMeetOnlyWhenAsked) {
  for (const bool collide : {false, true}) {
    HungBall p;
    JointDef def = p.ball();
    def.frame_b.position = {-0.5_m, {}, {}};
    def.frame_a.position = {0.25_m, {}, {}};
    def.collide = collide;
    ASSERT_TRUE(p.world.create_joint(def).ok());
    EXPECT_EQ(p.world.step().contacts, collide ? 1U : 0U);
  }
}

TEST(JointStore, LoadedGivesTheSameStateAndRefusesForgedRecords) {
  HungBall p;
  ASSERT_TRUE(p.world.create_joint(p.ball()).ok());
  (void)p.world.step();
  for (const SnapshotKind kind : {SnapshotKind::native, SnapshotKind::canonical}) {
    World copy = test::make_world(k_def);
    ASSERT_EQ(copy.load(kind, test::save(p.world, kind)), Status::ok);
    EXPECT_EQ(copy.hash().total, p.world.hash().total);
    EXPECT_EQ(copy.joint_count(), 1U);
  }
  const std::vector<std::byte> saved = test::save(p.world, SnapshotKind::canonical);
  const std::size_t joint = saved.size() - 8 - sizeof(JointRecord);
  int refused = 0;
  for (std::size_t at = joint; at + 8 < saved.size(); ++at) {
    std::vector<std::byte> forged = saved;
    forged[at] = std::byte{0xff};
    const std::uint64_t hash = hash64(ByteView(forged).first(forged.size() - 8));
    for (std::size_t i = 0; i < 8; ++i)
      forged[forged.size() - 8 + i] = static_cast<std::byte>(hash >> (8 * i));
    World target = test::make_world(k_def);
    if (target.load(SnapshotKind::canonical, forged) == Status::ok) {
      test::step(target, 2);
    } else {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST(JointStore, DifferencesAreNamed) {
  HungBall p;
  const JointHandle joint = p.world.create_joint(p.ball()).value();
  const std::vector<std::byte> before = test::save(p.world, SnapshotKind::canonical);
  AngularAxis axis;
  axis.speed = 2_rps;
  ASSERT_EQ(p.world.apply(SetAngularAxis{joint, 1, axis}), Status::ok);
  const StateDifference found =
      p.world.describe_difference(before, test::save(p.world, SnapshotKind::canonical));
  EXPECT_EQ(found.store, "joint");
  EXPECT_EQ(found.field, "angular[1].speed");
}

}  // namespace
}  // namespace lockstone
