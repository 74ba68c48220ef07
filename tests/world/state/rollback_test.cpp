// Going back: by native snapshots, whole or as differences from another one.

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

World jointed_world(BroadPhaseKind broad_phase = BroadPhaseKind::tree) {
  World world = test::make_world({.body_capacity = 128,
                                  .pair_capacity = 4096,
                                  .contact_capacity = 1024,
                                  .joint_capacity = 8,
                                  .broad_phase = broad_phase});
  test::fill_with_random_bodies(world, test::run_seed(), 60);
  for (std::uint32_t i = 0; i < 4; ++i) {
    JointDef def;
    def.kind = JointKind::distance;
    def.body_a = world.body_at(1 + i);
    def.body_b = world.body_at(2 + i);
    EXPECT_TRUE(world.create_joint(def).ok());
  }
  return world;
}

Bytes delta_of(const World& world, const Bytes& base) {
  Bytes bytes(world.delta_bytes_max());
  bytes.resize(world.save_delta(base, bytes));
  return bytes;
}

// The changes by a game between two ticks: bodies and joints come, go, and are pushed.
void disturb(World& world, test::Random& random) {
  const auto any = [&] { return world.body_at(static_cast<std::uint32_t>(random.between(1, 70))); };
  const BodyHandle pushed = any(), destroyed = any();
  const auto speed = Velocity::from_integer(random.between(-4, 4));
  if (!pushed.is_null()) (void)world.apply(SetVelocity{pushed, {speed, 3_mps, {}}});
  const std::int64_t what = random.between(0, 11);
  if (what == 0 && !destroyed.is_null()) (void)world.apply(DestroyBody{destroyed});
  if (what == 1) {
    test::add(world, test::dynamic_body(Shape::box(0.25_m, 0.5_m, 0.5_m),
                                        Position::from_integer(random.between(-2, 2)), 9_m, {}));
  }
  if (what == 2) (void)world.apply(DestroyJoint{world.joint_at(0)});
}

class Rollback : public ::testing::TestWithParam<BroadPhaseKind> {};

TEST_P(Rollback, GoesTheSameWayAgain) {
  World plain = jointed_world(GetParam()), rolled = jointed_world(GetParam());
  const std::uint64_t seed = test::run_seed();
  test::Random of_plain(seed), detour(seed + 1);
  test::step(plain, 30);
  test::step(rolled, 30);
  for (int round = 0; round < 60; ++round) {
    const Bytes saved = test::save(rolled, SnapshotKind::native);
    for (std::int64_t tick = detour.between(0, 9); tick > 0; --tick) {
      disturb(rolled, detour);
      (void)rolled.step();
    }
    ASSERT_EQ(rolled.load(SnapshotKind::native, saved), Status::ok);
    ASSERT_EQ(rolled.hash().total, plain.hash().total) << "round " << round;
    test::Random same = of_plain;
    disturb(plain, of_plain);
    disturb(rolled, same);
    test::step(plain, 4);
    test::step(rolled, 4);
    ASSERT_EQ(rolled.hash().total, plain.hash().total)
        << "round " << round << ": "
        << plain
               .describe_difference(test::save(plain, SnapshotKind::canonical),
                                    test::save(rolled, SnapshotKind::canonical))
               .to_line();
  }
}

INSTANTIATE_TEST_SUITE_P(BroadPhases, Rollback,
                         ::testing::Values(BroadPhaseKind::tree, BroadPhaseKind::sweep_and_prune));

TEST(Rollback, PastTheNightOfSleepersGoesTheSameWayAgain) {
  World plain = jointed_world(), rolled = jointed_world();
  test::step(plain, 300);
  test::step(rolled, 300);
  const Bytes saved = test::save(rolled, SnapshotKind::native);
  for (std::uint32_t i = 1; i < 61; i += 3) {
    (void)rolled.apply(SetVelocity{rolled.body_at(i), {2_mps, 5_mps, {}}});
    test::step(rolled, 10);
    ASSERT_EQ(rolled.load(SnapshotKind::native, saved), Status::ok);
    ASSERT_EQ(rolled.hash().total, plain.hash().total);
  }
  (void)plain.apply(SetVelocity{plain.body_at(30), {2_mps, 5_mps, {}}});
  (void)rolled.apply(SetVelocity{rolled.body_at(30), {2_mps, 5_mps, {}}});
  test::step(plain, 60);
  test::step(rolled, 60);
  EXPECT_EQ(rolled.hash().total, plain.hash().total);
}

TEST(Delta, WithItsBaseIsTheWholeState) {
  World world = jointed_world(), other = jointed_world();
  test::Random random;
  Bytes base = test::save(world, SnapshotKind::native);
  for (int round = 0; round < 60; ++round) {
    disturb(world, random);
    test::step(world, static_cast<int>(random.between(0, 5)));
    const Bytes delta = delta_of(world, base);
    ASSERT_FALSE(delta.empty());
    ASSERT_EQ(other.load_delta(base, delta), Status::ok);
    EXPECT_EQ(test::save(other, SnapshotKind::native), test::save(world, SnapshotKind::native));
    ASSERT_EQ(other.hash().total, world.hash().total);
    if (round % 3 == 0) base = test::save(world, SnapshotKind::native);
  }
  test::step(world, 30);
  test::step(other, 30);
  EXPECT_EQ(other.hash().total, world.hash().total);
}

TEST(Delta, OfAWorldAtRestIsSmall) {
  World world = test::make_world();
  test::add_ground(world);
  for (int i = 0; i < 60; ++i) {
    const Shape box = Shape::box(0.5_m, 0.5_m, 0.5_m);
    test::add(world, test::dynamic_body(box, Position::from_integer(2 * (i % 8)), 0.5_m,
                                        Position::from_integer(2 * (i / 8))));
  }
  test::step(world, 120);
  const Bytes base = test::save(world, SnapshotKind::native);
  BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 30_m, 20_m, {}));
  const Bytes before = test::save(world, SnapshotKind::native);
  (void)world.step();
  const std::size_t delta = delta_of(world, before).size();
  EXPECT_LT(delta, 1000U);
  EXPECT_LT(delta * 10, base.size());
  EXPECT_TRUE(world.exists(ball));
}

TEST(Delta, OfAnotherBaseOrCutShortIsRefused) {
  World world = jointed_world();
  const Bytes base = test::save(world, SnapshotKind::native);
  test::step(world, 60);
  const Bytes delta = delta_of(world, base);
  const std::uint64_t hash = world.hash().total;
  for (std::size_t size = 0; size < delta.size(); size += 1 + size / 8)
    EXPECT_NE(world.load_delta(base, ByteView(delta).first(size)), Status::ok) << size;
  EXPECT_NE(world.load_delta(ByteView(base).first(base.size() - 1), delta), Status::ok);
  EXPECT_EQ(world.hash().total, hash);
  Bytes small(delta.size() - 1);
  EXPECT_EQ(world.save_delta(base, small), 0U);
  EXPECT_EQ(world.save_delta({}, small), 0U);
}

}  // namespace
}  // namespace lockstone
