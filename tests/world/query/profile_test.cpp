// A profile tells where time goes and changes nothing.

#include <gtest/gtest.h>

#include <lockstone/profile.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

World profiled_world() {
  World world = test::make_world();
  test::fill_with_random_bodies(world, 7, 120);
  return world;
}

std::vector<std::uint64_t> hash_chain(World world, int ticks) {
  std::vector<std::uint64_t> chain;
  for (int tick = 0; tick < ticks; ++tick) {
    (void)world.step();
    chain.push_back(world.hash().total);
  }
  return chain;
}

TEST(Profile, ChangesNoState) {
  const std::vector<std::uint64_t> plain = hash_chain(profiled_world(), 60);
  for (const ProfileDetail detail : {ProfileDetail::stages, ProfileDetail::pairs}) {
    World world = profiled_world();
    world.set_clock(test::counting_clock, detail);
    EXPECT_EQ(hash_chain(std::move(world), 60), plain);
  }
  World other = test::make_world();
  test::fill_with_random_bodies(other, 8, 120);
  EXPECT_NE(hash_chain(std::move(other), 60), plain);
}

TEST(Profile, IsNotSaved) {
  World plain = profiled_world(), timed = profiled_world();
  timed.set_clock(test::counting_clock, ProfileDetail::pairs);
  test::step(plain, 20);
  test::step(timed, 20);
  for (const SnapshotKind kind : {SnapshotKind::native, SnapshotKind::canonical})
    EXPECT_EQ(test::save(plain, kind), test::save(timed, kind));
}

TEST(Profile, TakesNoTimesWithoutAClock) {
  World world = profiled_world();
  world.set_clock(test::counting_clock, ProfileDetail::pairs);
  world.set_clock(nullptr);
  const std::uint64_t calls = test::clock_calls();
  test::step(world, 20);
  EXPECT_EQ(test::clock_calls(), calls);
  EXPECT_EQ(world.profile().steps, 0U);
  EXPECT_EQ(world.profile().ticks_of(StepStage::collide), 0U);
}

TEST(Profile, CallsTheClockTwiceAStage) {
  World world = profiled_world();
  world.set_clock(test::counting_clock);
  const std::uint64_t calls = test::clock_calls();
  test::step(world, 20);
  const StepProfile& profile = world.profile();
  EXPECT_EQ(test::clock_calls() - calls, 20 * 2 * k_step_stages);
  EXPECT_EQ(profile.steps, 20U);
  for (const std::uint64_t ticks : profile.stage_ticks)
    EXPECT_EQ(ticks, 20U);
  EXPECT_EQ(profile.pairs_of(ShapeKind::box, ShapeKind::box).pairs, 0U);
}

TEST(Profile, CountsEveryPairUnderItsKinds) {
  World world = profiled_world();
  world.set_clock(test::counting_clock, ProfileDetail::pairs);
  std::uint64_t pairs = 0, contacts = 0;
  for (int tick = 0; tick < 60; ++tick) {
    const StepReport report = world.step();
    pairs += report.pairs;
    contacts += report.contacts;
  }
  PairProfile sum;
  for (const auto& row : world.profile().pair_kinds) {
    for (const PairProfile& kinds : row) {
      EXPECT_EQ(kinds.ticks, kinds.pairs);
      sum.pairs += kinds.pairs;
      sum.in_contact += kinds.in_contact;
      sum.manifolds += kinds.manifolds;
    }
  }
  EXPECT_EQ(sum.pairs, pairs);
  EXPECT_EQ(sum.manifolds, contacts);
  EXPECT_EQ(sum.in_contact, contacts);
  const StepProfile& profile = world.profile();
  EXPECT_GT(profile.pairs_of(ShapeKind::box, ShapeKind::sphere).manifolds, 0U);
  EXPECT_EQ(&profile.pairs_of(ShapeKind::box, ShapeKind::sphere),
            &profile.pairs_of(ShapeKind::sphere, ShapeKind::box));
}

TEST(Profile, CountsTriggersAsPairsWithoutManifolds) {
  World world = test::make_world();
  BodyDef zone;
  zone.motion = MotionType::static_body;
  zone.is_trigger = true;
  test::add(world, zone);
  test::add(world, {});
  world.set_clock(test::counting_clock, ProfileDetail::pairs);
  (void)world.step();
  const PairProfile& spheres = world.profile().pairs_of(ShapeKind::sphere, ShapeKind::sphere);
  EXPECT_EQ(spheres.pairs, 1U);
  EXPECT_EQ(spheres.manifolds, 0U);
}

TEST(StepStage, HasAName) {
  EXPECT_STREQ(name_of(StepStage::find_pairs), "find_pairs");
  EXPECT_STREQ(name_of(StepStage::events), "events");
  EXPECT_EQ(static_cast<std::size_t>(StepStage::sleep) + 1, k_step_stages);
}

// A ball at rest does not move by a bit for many ticks; dropped manifolds are found again.
TEST(Profile, CountsManifoldsThatWereReused) {
  const auto reused_by = [](bool forgets) {
    World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
    test::add_ground(world);
    test::add(world, test::dynamic_body(Shape::sphere(Length::from_ratio(1, 2)), {},
                                        Position::from_ratio(1, 2), {}));
    world.set_clock(test::counting_clock, ProfileDetail::pairs);
    for (int tick = 0; tick < 300; ++tick) {
      if (forgets) world.drop_derived();
      (void)world.step();
    }
    const auto& kinds = world.profile().pair_kinds;
    return kinds[static_cast<std::size_t>(ShapeKind::sphere)]
                [static_cast<std::size_t>(ShapeKind::box)]
                    .reused;
  };
  EXPECT_GT(reused_by(false), 50U);
  EXPECT_EQ(reused_by(true), 0U);
}

}  // namespace
}  // namespace lockstone
