// Invariants at any moment, between any two commands: a save loads and goes on alike, and a command
// that is refused has changed nothing. Random commands from listed seeds.

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
#include "tests/world/random_commands.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

constexpr std::uint64_t k_all_seeds = 60;  // 0 … 59
constexpr auto k_seeds = test::share_of(k_all_seeds);
constexpr int k_ticks = 40;

std::string difference(const World& a, const World& b) {
  return a
      .describe_difference(test::save(a, SnapshotKind::canonical),
                           test::save(b, SnapshotKind::canonical))
      .to_line();
}

// One world goes on as it is; a second is loaded again from the first's canonical bytes now and
// then, a third goes elsewhere for some ticks and comes back by native bytes.
class Trio {
 public:
  explicit Trio(std::uint64_t seed)
      : random_(seed),
        plain_(make()),
        loaded_(make()),
        rolled_(make()),
        dice_(plain_, random_, seed % 2 == 1) {}

  void run() {
    for (int tick = 0; tick < k_ticks && !::testing::Test::HasFailure(); ++tick) {
      for (std::size_t commands = random_.below(5); commands > 0; --commands) {
        apply(dice_.any());
        if (random_.below(3) == 0) save_and_load();
      }
      if (random_.below(3) == 0) save_and_load();
      step();
      expect_alike();
    }
  }

 private:
  World make() {
    test::Random same(1);
    return test::make_crowd(same);
  }

  void apply(const Command& command) {
    const Status status = plain_.apply(command);
    EXPECT_EQ(loaded_.apply(command), status);
    EXPECT_EQ(rolled_.apply(command), status);
  }

  void step() {
    const StepReport report = plain_.step();
    EXPECT_EQ(loaded_.step().saturations, report.saturations);
    EXPECT_EQ(rolled_.step().saturations, report.saturations);
    EXPECT_EQ(test::told_by(loaded_), test::told_by(plain_)) << "tick " << plain_.tick();
    EXPECT_EQ(test::told_by(rolled_), test::told_by(plain_)) << "tick " << plain_.tick();
  }

  void save_and_load() {
    const Bytes canonical = test::save(plain_, SnapshotKind::canonical);
    const Bytes native = test::save(plain_, SnapshotKind::native);
    loaded_ = World::create(test::crowd_def(), test::crowd_assets()).value();
    ASSERT_EQ(loaded_.load(SnapshotKind::canonical, canonical), Status::ok)
        << "tick " << plain_.tick();
    EXPECT_FALSE(loaded_.find_fault()) << loaded_.find_fault().what;
    for (std::size_t detour = random_.below(4); detour > 0; --detour)
      (void)rolled_.step();
    ASSERT_EQ(rolled_.load(SnapshotKind::native, native), Status::ok);
    EXPECT_FALSE(rolled_.find_fault()) << rolled_.find_fault().what;
    expect_alike();
  }

  void expect_alike() {
    ASSERT_EQ(loaded_.hash().total, plain_.hash().total) << difference(plain_, loaded_);
    ASSERT_EQ(rolled_.hash().total, plain_.hash().total) << difference(plain_, rolled_);
  }

  test::Random random_;
  World plain_, loaded_, rolled_;
  test::CommandDice dice_;
};

TEST(AtAnyMoment, ASaveLoadsAndGoesOnAlikeEventsIncluded) {
  for (std::uint64_t seed = 0; seed < k_seeds && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Trio(seed).run();
  }
}

TEST(AtAnyMoment, ACommandThatIsRefusedHasChangedNothing) {
  std::vector<int> refused(test::k_command_kinds + 1), taken(test::k_command_kinds + 1);
  const auto is_any_kind_missing = [&] {  // the first entry is that of "no command"
    return std::count(refused.begin() + 1, refused.end(), 0) > 0 ||
           std::count(taken.begin() + 1, taken.end(), 0) > 0;
  };
  // A part of the seeds may refuse too little: then more of them.
  const auto is_wanted = [&](std::uint64_t seed) {
    return seed < k_seeds || (seed < k_all_seeds && is_any_kind_missing());
  };
  for (std::uint64_t seed = 0; is_wanted(seed) && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    World world = test::make_crowd(random);
    test::CommandDice dice(world, random, true);
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
      if (random.below(10) == 0) (void)world.step();
      const Bytes canonical = test::save(world, SnapshotKind::canonical);
      const Bytes native = test::save(world, SnapshotKind::native);
      const std::uint64_t hash = world.hash().total;
      const Command command = dice.any();
      const bool ok = world.apply(command) == Status::ok;
      ++(ok ? taken : refused)[command.index()];
      if (ok) continue;
      EXPECT_EQ(world.hash().total, hash) << "command " << command.index();
      EXPECT_EQ(test::save(world, SnapshotKind::canonical), canonical) << command.index();
      EXPECT_EQ(test::save(world, SnapshotKind::native), native) << command.index();
      EXPECT_FALSE(world.find_fault()) << world.find_fault().what;
    }
  }
  for (std::size_t kind = 1; kind <= test::k_command_kinds; ++kind) {
    EXPECT_GT(refused[kind], 0) << "command " << kind;
    EXPECT_GT(taken[kind], 0) << "command " << kind;
  }
}

// An awake body of another kind on a joint wakes its partner in the next step, not before.
TEST(SleepBody, ThatIsRefusedWakesNothing) {
  World world = test::make_world({.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64});
  BodyDef def = test::dynamic_body(Shape::sphere(0.2_m), {}, {}, {});
  const BodyHandle sleeper = test::add(world, def);
  def.position.x = 1_m, def.motion = MotionType::kinematic;
  const BodyHandle kinematic = test::add(world, def);
  def.position.x = 9_m, def.motion = MotionType::dynamic, def.allow_sleep = false;
  const BodyHandle restless = test::add(world, def);
  ASSERT_TRUE(world.create_joint(JointDef::of(JointKind::distance, sleeper, kinematic)).ok());
  ASSERT_EQ(world.apply(SleepBody{sleeper}), Status::ok);
  const std::uint64_t before = world.hash().total;
  EXPECT_EQ(world.apply(SleepBody{restless}), Status::invalid_argument);
  EXPECT_EQ(world.hash().total, before);
  EXPECT_TRUE(world.body(sleeper).is_asleep);
  (void)world.step();
  EXPECT_FALSE(world.body(sleeper).is_asleep);
}

TEST(WakeEvent, OutlivesASaveBetweenTheCommandAndTheStep) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {}));
  test::step(world, 90);
  ASSERT_TRUE(world.body(box).is_asleep);
  ASSERT_EQ(world.apply(WakeBody{box}), Status::ok);
  for (const SnapshotKind kind : {SnapshotKind::canonical, SnapshotKind::native}) {
    World loaded = test::make_world();
    ASSERT_EQ(loaded.load(kind, test::save(world, kind)), Status::ok);
    (void)loaded.step();
    ASSERT_EQ(loaded.events().size(), 1U);
    EXPECT_EQ(loaded.events()[0].kind, EventKind::wake);
  }
  (void)world.step();
  ASSERT_EQ(world.events().size(), 1U);
  EXPECT_EQ(world.events()[0].a, box);
}

}  // namespace
}  // namespace lockstone
