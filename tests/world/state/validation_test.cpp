// Level 2 finds nothing wrong with a valid world, and finds every injected fault.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/mesh.h>
#include <lockstone/thread_pool.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

// Boxes that fall, hang on joints, and come to rest.
World make_mixture() {
  World world = test::make_world();
  test::fill_with_random_bodies(world, 9, 50);
  BodyHandle last =
      test::add(world, test::dynamic_body(Shape::box(0.3_m, 0.3_m, 0.3_m), 20_m, 3_m, {}));
  for (int i = 1; i < 4; ++i) {
    const Position x = Position::from_integer(20 + i);
    const BodyHandle next =
        test::add(world, test::dynamic_body(Shape::box(0.3_m, 0.3_m, 0.3_m), x, 3_m, {}));
    JointDef joint = JointDef::of(JointKind::ball, last, next);
    joint.frame_a.position.x = 0.5_m;
    joint.frame_b.position.x = -0.5_m;
    EXPECT_TRUE(world.create_joint(joint).ok());
    last = next;
  }
  return world;
}

TEST(Validation, FindsNothingWrongAfterAnyStage) {
  ThreadPool pool(3);
  World world = make_mixture(), plain = make_mixture();
  world.set_validation(true);
  world.set_task_runner(&pool, TaskPieces::smallest);
  for (int tick = 0; tick < 200; ++tick) {
    if (tick == 100) {
      EXPECT_EQ(world.apply(DestroyBody{world.body_at(5)}), Status::ok);
      EXPECT_EQ(plain.apply(DestroyBody{plain.body_at(5)}), Status::ok);
    }
    ASSERT_EQ(world.step(), plain.step());
  }
  EXPECT_EQ(world.hash().total, plain.hash().total);
}

TEST(Validation, FindsNothingWrongBetweenCommandsAndSteps) {
  World world = make_mixture();
  test::step(world, 30);
  EXPECT_EQ(world.apply(SetVelocity{world.body_at(3), {1_mps, {}, {}}}), Status::ok);
  EXPECT_FALSE(world.find_fault()) << world.find_fault().what;
  world.drop_derived();
  EXPECT_FALSE(world.find_fault()) << world.find_fault().what;
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  test::step(world, 300);
  EXPECT_FALSE(world.find_fault()) << world.find_fault().what;
  ASSERT_EQ(world.load(SnapshotKind::canonical, saved), Status::ok);
  EXPECT_FALSE(world.find_fault()) << world.find_fault().what;
}

struct Flip {
  const char* store;
  std::uint64_t object;
  const char* field;
  unsigned bit;
  const char* what;
};

TEST(Validation, FindsEachKindOfFault) {
  const Flip flips[] = {
      {"body", 3, "orientation.w", 29, "a body's record"},
      {"body", 3, "position.x", 33, "the bounds of a body"},
      {"body", 3, "recycling_place.x", 17, "the recycling pose of a body"},
      {"body", 3, "recycling_place.x", 0, "the pose delta of a body"},
      {"body", 3, "inverse_mass", 30, "a body's record"},
      {"body", 3, "orientation.x", 1, "the rotation of a body"},
      {"contact", 0, "body_a", 20, "a contact of no body"},
      {"contact", 0, "flags", 7, "a contact's record"},
      {"joint", 1, "body_b", 21, "a joint of no body"},
      {"body", 3, "user_data", 5, nullptr},  // whatever it is, it is right
      {"world", 0, "contact_count", 0, "the number of contacts"},
  };
  for (const Flip& flip : flips) {
    World world = make_mixture();
    test::step(world, 90);
    ASSERT_FALSE(world.find_fault());
    ASSERT_TRUE(world.flip_bit(flip.store, flip.object, flip.field, flip.bit)) << flip.field;
    const WorldFault fault = world.find_fault();
    if (flip.what == nullptr) {
      EXPECT_FALSE(fault) << flip.field;
      continue;
    }
    ASSERT_TRUE(fault) << flip.field;
    EXPECT_STREQ(fault.what, flip.what) << flip.field;
  }
}

TEST(ValidationDeathTest, StopsAtAFault) {
  World world = make_mixture();
  test::step(world, 90);
  world.set_validation(true);
  ASSERT_TRUE(world.flip_bit("contact", 0, "flags", 7));
  EXPECT_DEATH((void)world.step(), "after .*: a contact's record");
}

}  // namespace
}  // namespace lockstone
