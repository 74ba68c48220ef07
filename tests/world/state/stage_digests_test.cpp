// Stage digests name the stage in which two runs part.

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

World falling_boxes() {
  World world = test::make_world();
  test::fill_with_random_bodies(world, 3, 30);
  test::step(world, 60);
  world.trace_stages(true);
  return world;
}

StepStage first_difference(const World& a, const World& b) {
  for (std::size_t i = 0; i < k_step_stages; ++i) {
    if (a.stage_digests().after[i] != b.stage_digests().after[i]) return static_cast<StepStage>(i);
  }
  return StepStage{k_step_stages};
}

// The last body that moves: nobody's first choice of contact.
BodyHandle last_body(const World& world) {
  BodyHandle body;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    if (!world.body_at(i).is_null()) body = world.body_at(i);
  }
  return body;
}

TEST(StageDigests, AreEqualInEqualRuns) {
  World a = falling_boxes(), b = falling_boxes();
  for (int tick = 0; tick < 30; ++tick) {
    static_cast<void>(a.step());
    static_cast<void>(b.step());
    EXPECT_EQ(a.stage_digests(), b.stage_digests());
  }
  EXPECT_EQ(first_difference(a, b), StepStage{k_step_stages});
}

TEST(StageDigests, ChangeNoResult) {
  World a = falling_boxes(), b = falling_boxes();
  b.trace_stages(false);
  test::step(a, 30);
  test::step(b, 30);
  EXPECT_EQ(a.hash().total, b.hash().total);
  EXPECT_EQ(b.stage_digests(), StageDigests{});
}

TEST(StageDigests, TellACommandFromAStage) {
  World a = falling_boxes(), b = falling_boxes();
  const BodyHandle body = last_body(b);
  Vec3<Velocity> velocity = b.velocity(body);
  velocity.y.raw ^= 1 << 14;
  ASSERT_EQ(b.apply(SetVelocity{body, velocity}), Status::ok);
  static_cast<void>(a.step());
  static_cast<void>(b.step());
  EXPECT_NE(a.stage_digests().before, b.stage_digests().before);
  EXPECT_NE(first_difference(a, b), StepStage{k_step_stages});
}

TEST(StageDigests, DifferFromTheStageOnThatReadsAFlippedImpulse) {
  World a = falling_boxes(), b = falling_boxes();
  ASSERT_TRUE(b.flip_bit("contact", 0, "point[0].normal_impulse", 12));
  World c = test::make_world();
  ASSERT_EQ(c.load(SnapshotKind::native, test::save(b, SnapshotKind::native)), Status::ok);
  c.trace_stages(true);
  static_cast<void>(a.step());
  static_cast<void>(c.step());
  EXPECT_EQ(a.stage_digests().before, c.stage_digests().before);
  EXPECT_EQ(first_difference(a, c), StepStage::collide);  // whose records carry the impulse on
}

}  // namespace
}  // namespace lockstone
