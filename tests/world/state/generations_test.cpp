// Handles at the end of their numbers: a slot whose generations are used up is never used again.

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

constexpr std::uint32_t k_last = 0xfffffffe, k_beyond = 0xffffffff;

WorldDef small_def() {
  return {.body_capacity = 4, .pair_capacity = 16, .contact_capacity = 16, .joint_capacity = 2};
}

// Two balls on a joint, each first of its kind.
World joined() {
  World world = test::make_world(small_def());
  const BodyHandle a = test::add(world, test::dynamic_body(Shape::sphere(0.1_m), {}, {}, {}));
  const BodyHandle b = test::add(world, test::dynamic_body(Shape::sphere(0.1_m), 1_m, {}, {}));
  EXPECT_TRUE(world.create_joint(JointDef::of(JointKind::distance, a, b)).ok());
  return world;
}

// Canonical bytes of a world whose first object of the store, of generation 1, has another one.
Bytes with_generation(World world, const char* store, std::uint32_t generation) {
  const std::uint32_t change = 1U ^ generation;
  for (unsigned bit = 0; bit < 32; ++bit) {
    if ((change >> bit & 1) == 0) continue;
    EXPECT_TRUE(world.flip_bit(store, 0, "generation", bit));
  }
  return test::save(world, SnapshotKind::canonical);
}

TEST(Generation, OfABodyNeverReturns) {
  World world = test::make_world(small_def());
  ASSERT_EQ(world.load(SnapshotKind::canonical, with_generation(joined(), "body", k_last)),
            Status::ok);
  const BodyHandle last{0, k_last};
  ASSERT_TRUE(world.exists(last));
  ASSERT_EQ(world.apply(DestroyBody{last}), Status::ok);
  for (int i = 0; i < 2; ++i) {
    const Result<BodyHandle> next = world.create_body({});
    ASSERT_TRUE(next.ok());
    EXPECT_EQ(next.value().index, 2U + static_cast<std::uint32_t>(i));
    EXPECT_FALSE(next.value().is_null());
  }
  EXPECT_EQ(world.create_body({}).status(), Status::capacity_exhausted);
  EXPECT_FALSE(world.exists(last));
  EXPECT_TRUE(world.body_at(0).is_null());
  EXPECT_FALSE(world.find_fault());
}

TEST(Generation, OfAJointNeverReturns) {
  World world = test::make_world(small_def());
  ASSERT_EQ(world.load(SnapshotKind::canonical, with_generation(joined(), "joint", k_last)),
            Status::ok);
  const JointHandle last{0, k_last};
  ASSERT_TRUE(world.exists(last));
  ASSERT_EQ(world.apply(DestroyJoint{last}), Status::ok);
  const JointDef def = JointDef::of(JointKind::ball, world.body_at(0), world.body_at(1));
  const Result<JointHandle> next = world.create_joint(def);
  ASSERT_TRUE(next.ok());
  EXPECT_EQ(next.value(), (JointHandle{1, 1}));
  EXPECT_EQ(world.create_joint(def).status(), Status::capacity_exhausted);
  EXPECT_FALSE(world.exists(last));
}

TEST(Generation, ThatIsUsedUpStaysSoInSnapshots) {
  World world = test::make_world(small_def()), copy = test::make_world(small_def());
  ASSERT_EQ(world.load(SnapshotKind::canonical, with_generation(joined(), "body", k_last)),
            Status::ok);
  ASSERT_EQ(world.apply(DestroyBody{{0, k_last}}), Status::ok);
  for (const SnapshotKind kind : {SnapshotKind::canonical, SnapshotKind::native}) {
    ASSERT_EQ(copy.load(kind, test::save(world, kind)), Status::ok);
    EXPECT_EQ(copy.create_body({}).value().index, 2U);
  }
}

TEST(Generation, BeyondTheLastIsRefusedInSnapshots) {
  World world = test::make_world(small_def());
  for (const char* store : {"body", "joint"}) {
    EXPECT_EQ(world.load(SnapshotKind::canonical, with_generation(joined(), store, k_beyond)),
              Status::malformed);
    EXPECT_EQ(world.load(SnapshotKind::canonical, with_generation(joined(), store, 0)),
              Status::malformed);
  }
  EXPECT_EQ(world.body_count(), 0U);
}

}  // namespace
}  // namespace lockstone
