// Islands that stand still are not solved, and are solved again as soon as anything differs.
//
// The reference is a world with the same state whose bodies are woken in each tick, so that none of
// its islands is ever still.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/rotation.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/joints/joint_fixture.h"
#include "tests/world/random_commands.h"
#include "tests/world/sleep/sleepers.h"

namespace lockstone {
namespace {

using namespace literals;
using test::add_stack;
using test::unit_box;

// Nothing sleeps in it.
World make_sleepless_world() {
  WorldDef def{.body_capacity = 64, .pair_capacity = 512, .contact_capacity = 512};
  def.joint_capacity = 16;
  def.sleep_ms = 0;
  return test::make_world(def);
}

// A stack of three that stands still on the ground.
struct StillStack {
  World world = make_sleepless_world();
  BodyHandle ground = test::add_ground(world);
  std::vector<BodyHandle> stack = add_stack(world, {}, 3);

  StillStack() {
    test::step(world, 60);
    EXPECT_EQ(world.step().still_bodies, 3U);
  }
  void apply(const Command& command) { EXPECT_EQ(world.apply(command), Status::ok); }
  [[nodiscard]] std::uint32_t still_after_a_step() { return world.step().still_bodies; }
};

void make_belt(World& world, BodyHandle body) {
  SetSurfaceMotion belt{body};
  belt.motion.velocity.x = SolverVelocity::from_ratio(1, 1000);
  ASSERT_EQ(world.apply(belt), Status::ok);
}

double newtons(Force force) {
  return test::number(force.raw, Force::frac_bits);
}

void wake_all(World& world) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i)
    if (const BodyHandle body = world.body_at(i); world.exists(body))
      (void)world.apply(WakeBody{body});
}

// The greatest difference of a component of a body's velocity, m/s.
double velocity_difference(const World& a, const World& b) {
  double most = 0;
  for (std::uint32_t i = 0; i < a.body_limit(); ++i) {
    const BodyHandle body = a.body_at(i);
    if (!a.exists(body)) continue;
    const Vec3<Velocity> difference = a.body(body).velocity - b.body(body).velocity;
    for (int axis = 0; axis < 3; ++axis)
      most = std::max(most, std::abs(test::metres_per_second(difference[axis])));
  }
  return most;
}

// Steps a world until something in it is still. Returns the number of steps, 120 at most.
int ticks_until_still(World& world) {
  int ticks = 1;
  while (world.step().still_bodies == 0 && ticks < 120)
    ++ticks;
  return ticks;
}

TEST(StillIslands, AreStillOneByOneAfterAnEighthOfASecond) {
  World world = make_sleepless_world();
  test::add_ground(world);
  add_stack(world, {}, 1);
  const int ticks = ticks_until_still(world);
  EXPECT_GE(ticks, 8);
  EXPECT_LE(ticks, 20);
}

// Below 2^-18 m/s along each axis, and moved by less than 2^-14 m/s would in a tick.
bool is_settled(const World& world, BodyHandle body, const Vec3<Position>& before) {
  const auto state = world.body(body);
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t way = state.position[axis].raw - before[axis].raw;
    if (std::abs(state.velocity[axis].raw) >= std::int64_t{1} << (Velocity::frac_bits - 18) ||
        60 * std::abs(way) >= std::int64_t{1} << (Position::frac_bits - 14))
      return false;
  }
  return true;
}

// Overlap closes for some ticks after velocities are gone.
TEST(StillIslands, AreStillTwoTicksAfterTheyHaveSettled) {
  for (int height = 2; height <= 8; ++height) {
    World world = make_sleepless_world();
    test::add_ground(world);
    const std::vector<BodyHandle> stack = add_stack(world, {}, height);
    std::vector<Vec3<Position>> before(stack.size());
    int settled = 0, ticks = 0;
    const auto step = [&] {
      for (std::size_t i = 0; i < stack.size(); ++i)
        before[i] = world.body(stack[i]).position;
      return world.step().still_bodies;
    };
    while (step() == 0 && ++ticks < 60) {
      bool all = true;
      for (std::size_t i = 0; i < stack.size(); ++i)
        all = all && is_settled(world, stack[i], before[i]);
      settled = all ? settled + 1 : 0;
    }
    EXPECT_EQ(settled, 2) << height;
    EXPECT_LE(ticks, 8) << height;
  }
}

TEST(StillIslands, AreCountedAndNotSolved) {
  World world = make_sleepless_world();
  test::add_ground(world);
  add_stack(world, {}, 3);
  EXPECT_LE(ticks_until_still(world), 20);
  const StepReport report = world.step();
  EXPECT_EQ(report.still_bodies, 3U);
  EXPECT_EQ(report.moving_bodies, 0U);
  EXPECT_EQ(report.contacts, 3U);
  EXPECT_EQ(report.contact_points, 12U);
}

TEST(StillIslands, KeepEveryBitOfTheirState) {
  StillStack still;
  const std::uint64_t bodies = still.world.hash().bodies, contacts = still.world.hash().contacts;
  test::step(still.world, 600);
  EXPECT_EQ(still.world.hash().bodies, bodies);
  EXPECT_EQ(still.world.hash().contacts, contacts);
}

// Three boxes of 1,000 kg each.
TEST(StillIslands, KeepTheForcesOfTheirContacts) {
  StillStack still;
  test::step(still.world, 100);
  std::array<BodyContact, 4> found;
  ASSERT_EQ(contacts_of(still.world, still.stack[0], found), 2U);
  const double weight = 9.81 * 1000 * 3;
  EXPECT_NEAR(newtons(found[0].normal_force), weight, 1e-3 * weight);
  EXPECT_NEAR(newtons(found[1].normal_force), weight * 2 / 3, 1e-3 * weight);
}

TEST(StillIslands, EndWhenABodyIsPushed) {
  StillStack still;
  still.apply(ApplyImpulse{still.stack[1], {Impulse::from_integer(1), {}, {}}});
  EXPECT_EQ(still.still_after_a_step(), 0U);
}

TEST(StillIslands, FallWhenTheLowestBodyIsDestroyed) {
  StillStack still;
  still.apply(DestroyBody{still.stack[0]});
  test::step(still.world, 10);
  EXPECT_LT(still.world.body(still.stack[1]).velocity.y, Velocity::from_integer(-1));
}

TEST(StillIslands, FallWhenTheGroundIsDestroyed) {
  StillStack still;
  still.apply(DestroyBody{still.ground});
  test::step(still.world, 10);
  EXPECT_LT(still.world.body(still.stack[2]).velocity.y, Velocity::from_integer(-1));
}

TEST(StillIslands, FollowAChangeOfGravity) {
  StillStack still;
  still.apply(SetGravity{{{}, 5_mps2, {}}});
  test::step(still.world, 10);
  EXPECT_GT(still.world.body(still.stack[2]).velocity.y, Velocity::from_ratio(1, 2));
}

TEST(StillIslands, EndWhenABodyArrives) {
  StillStack still;
  test::add(still.world, test::dynamic_body(unit_box(), 0.5_m, 4.5_m, {}));
  test::step(still.world, 30);
  EXPECT_EQ(still.still_after_a_step(), 0U);
}

TEST(StillIslands, DoNotIncludeBodiesOnAMovingSurface) {
  World world = make_sleepless_world();
  make_belt(world, test::add_ground(world));
  add_stack(world, {}, 2);
  for (int i = 0; i < 120; ++i)
    EXPECT_EQ(world.step().still_bodies, 0U);
}

// A box on a belt without friction, and far away a box on a plate, which may be a belt.
World make_smooth_belt(bool plate_is_belt) {
  World world = make_sleepless_world();
  make_belt(world, test::add_ground(world));
  BodyDef smooth = test::dynamic_body(unit_box(), {}, 0.5_m, {});
  smooth.material.friction = {};
  test::add(world, smooth);
  BodyDef plate = test::dynamic_body(unit_box(), 1000_m, {}, {});
  plate.motion = MotionType::static_body;
  const BodyHandle far_plate = test::add(world, plate);
  if (plate_is_belt) make_belt(world, far_plate);
  test::add(world, test::dynamic_body(unit_box(), 1000_m, 1_m, {}));
  return world;
}

// Its contact differs in each tick, and it does not move: its count depends on nothing else.
TEST(StillIslands, CountTicksWithoutLookingAtOtherIslands) {
  World beside_still = make_smooth_belt(false), beside_belt = make_smooth_belt(true);
  std::uint32_t still_bodies = 0;
  for (int tick = 0; tick < 40; ++tick) {
    still_bodies = beside_still.step().still_bodies;
    EXPECT_EQ(beside_belt.step().still_bodies, 0U);
    const StateDifference first =
        beside_still.describe_difference(test::save(beside_still, SnapshotKind::canonical),
                                         test::save(beside_belt, SnapshotKind::canonical));
    ASSERT_EQ(first.store, "body") << first.to_line();
    EXPECT_EQ(first.object, 2U) << "tick " << tick << ": " << first.to_line();
  }
  EXPECT_EQ(still_bodies, 1U);
}

// A stack of six. Without room among the converged islands it is iterated, and trembles.
World make_trembling_world(const Vec3<Acceleration>& gravity, Coefficient friction,
                           std::uint32_t converged_contacts = 4) {
  WorldDef def{.body_capacity = 64, .pair_capacity = 512, .contact_capacity = 512};
  def.joint_capacity = 16;
  def.sleep_ms = 0;
  def.converged_contacts = converged_contacts;
  def.gravity = gravity;
  World world = test::make_world(def);
  BodyDef ground = test::dynamic_body(Shape::box(100_m, 1_m, 100_m), {}, -1_m, {});
  ground.motion = MotionType::static_body;
  ground.material.friction = friction;
  test::add(world, ground);
  for (int i = 0; i < 6; ++i) {
    BodyDef box = test::dynamic_body(unit_box(), {}, Position::from_ratio(2 * i + 1, 2), {});
    box.material.friction = friction;
    test::add(world, box);
  }
  return world;
}

TEST(StillIslands, IncludeStacksThatTrembleForAQuarterOfASecond) {
  World world = make_trembling_world(WorldDef{}.gravity, Coefficient::from_ratio(1, 2));
  const int ticks = ticks_until_still(world);
  EXPECT_GE(ticks, 15);
  EXPECT_LE(ticks, 60);
  EXPECT_EQ(world.step().still_bodies, 6U);
  const std::uint64_t bodies = world.hash().bodies;
  test::step(world, 600);
  EXPECT_EQ(world.hash().bodies, bodies);
}

// It gains more in a quarter of a second than such stacks tremble, iterated or converged.
TEST(StillIslands, DoNotIncludeAStackThatGainsSpeed) {
  const Vec3<Acceleration> leaning{
      Acceleration::from_ratio(6, 10'000), Acceleration::from_ratio(-981, 100), {}};
  for (const std::uint32_t converged_contacts : {4U, 64U}) {
    World world = make_trembling_world(leaning, {}, converged_contacts);
    for (int tick = 0; tick < 240; ++tick)
      EXPECT_EQ(world.step().still_bodies, 0U);
    for (std::uint32_t i = 1; i <= 6; ++i)
      EXPECT_NEAR(test::metres_per_second(world.body(world.body_at(i)).velocity.x), 2.4e-3, 1e-4);
  }
}

// Slower than stacks tremble, and nothing but inertia moves them.
TEST(StillIslands, DoNotIncludeBodiesThatDriftTogether) {
  World world = make_sleepless_world();
  ASSERT_EQ(world.apply(SetGravity{{}}), Status::ok);
  BodyDef box = test::dynamic_body(unit_box(), {}, {}, {});
  box.velocity.x = Velocity::from_ratio(1, 25'000);
  const BodyHandle left = test::add(world, box);
  box.position.x = 1_m;
  const BodyHandle right = test::add(world, box);
  JointDef weld = JointDef::of(JointKind::weld, left, right);
  weld.frame_a.position.x = 0.5_m;
  weld.frame_b.position.x = -0.5_m;
  test::join(world, weld);
  test::step(world, 600);
  EXPECT_EQ(world.step().still_bodies, 0U);
  EXPECT_NEAR(test::metres_per_second(world.body(left).velocity.x), 4e-5, 1e-6);
}

// A ball bounces off a wall within one tick, into a box that stands still: the box has its speed at
// the tick's end, and bounds that fit it, though it was not among the bodies that moved.
TEST(StillIslands, HaveBoundsThatFitTheirVelocityOnceTheyAreHit) {
  std::uint32_t hits = 0;
  for (int aside = -20; aside <= 20; ++aside) {
    World world = make_sleepless_world();
    test::add_ground(world);
    BodyDef mirror = test::dynamic_body(Shape::box(3_m, 1_m, 0.1_m), 5_m, 1_m, {});
    mirror.motion = MotionType::static_body;
    mirror.orientation =
        from_directions(Vec3<Unit>{{}, {}, Unit::from_integer(1)},
                        Vec3<Unit>{Unit::from_integer(-1), {}, Unit::from_integer(1)});
    mirror.material.restitution = Coefficient::from_integer(1);
    test::add(world, mirror);
    const BodyHandle box = test::add(world, test::dynamic_body(unit_box(), 4.6_m, 0.5_m, 2_m));
    test::step(world, 60);
    ASSERT_EQ(world.step().still_bodies, 1U);
    BodyDef ball = test::dynamic_body(Shape::sphere(0.1_m), {}, 0.6_m, {});
    ball.position.x = Position::from_ratio(aside, 10);
    ball.is_bullet = true;
    ball.velocity.x = Velocity::from_integer(300);
    ball.material.restitution = Coefficient::from_integer(1);
    test::add(world, ball);
    for (int tick = 0; tick < 3; ++tick) {
      const StepReport report = world.step();
      const WorldFault fault = world.find_fault();
      EXPECT_FALSE(fault) << fault.what << " " << fault.index << ", ball " << aside;
      hits += report.still_bodies == 1 && world.body(box).velocity != Vec3<Velocity>{} ? 1U : 0U;
    }
  }
  EXPECT_GT(hits, 0U);
}

// Towers of two slide at 40 µm/s: on their way of a tick one box in 1,465 reaches the next step of
// its bounds, which are in millimetres. Places are that far apart, so some box does when it stops.
TEST(StillIslands, HaveBoundsThatFitTheirVelocityOnceTheyStop) {
  constexpr std::uint32_t k_towers = 1465;
  WorldDef def;
  def.body_capacity = 2 * k_towers + 1;
  def.pair_capacity = def.contact_capacity = def.converged_contacts = 4 * k_towers;
  def.sleep_ms = 0;
  World world = test::make_world(def);
  BodyDef ground = test::dynamic_body(Shape::half_space(), {}, {}, {});
  ground.motion = MotionType::static_body;
  ground.material.friction = {};
  test::add(world, ground);
  for (std::uint32_t i = 0; i < 2 * k_towers; ++i) {
    BodyDef box = test::dynamic_body(unit_box(), {}, Position::from_ratio(i % 2 * 2 + 1, 2), {});
    box.position.x = Position::from_integer(i / 2 * 2) + Position::from_ratio(i / 2 * 2, 3'000'000);
    box.material.friction = {};
    box.velocity.x = Velocity::from_ratio(1, 25'000);
    test::add(world, box);
  }
  std::uint32_t still = 0;
  for (int tick = 0; tick < 30; ++tick) {
    still = world.step().still_bodies;
    const WorldFault fault = world.find_fault();
    EXPECT_FALSE(fault) << fault.what << " " << fault.index << ", tick " << tick;
  }
  EXPECT_EQ(still, 2 * k_towers);
}

TEST(StillIslands, DoNotIncludeBodiesInFreeFlight) {
  World world = make_sleepless_world();
  ASSERT_EQ(world.apply(SetGravity{{}}), Status::ok);
  test::add(world, test::dynamic_body(unit_box(), {}, {}, {}));
  test::step(world, 60);
  EXPECT_EQ(world.step().still_bodies, 0U);
}

// Stacks, a plank on two boxes, a box on a kinematic plate, two welded boxes, a box on a hook.
World make_still_yard() {
  World world = make_sleepless_world();
  test::add_ground(world);
  add_stack(world, {}, 3);
  add_stack(world, 4_m, 1);
  add_stack(world, 6_m, 1);
  test::add(world, test::dynamic_body(Shape::box(1.5_m, 0.1_m, 0.5_m), 5_m, 1.1_m, {}));
  BodyDef plate = test::dynamic_body(Shape::box(1_m, 0.1_m, 1_m), -4_m, 2_m, {});
  plate.motion = MotionType::kinematic;
  test::add(world, plate);
  test::add(world, test::dynamic_body(unit_box(), -4_m, 2.6_m, {}));
  const BodyHandle left = test::add(world, test::dynamic_body(unit_box(), 8_m, 0.5_m, {}));
  const BodyHandle right = test::add(world, test::dynamic_body(unit_box(), 9_m, 0.5_m, {}));
  JointDef weld = JointDef::of(JointKind::weld, left, right);
  weld.frame_a.position.x = 0.5_m;
  weld.frame_b.position.x = -0.5_m;
  test::join(world, weld);
  test::step(world, 60);
  return world;
}

// Commands of every kind: a still world goes on as one that is solved in every tick.
TEST(StillIslands, MoveAfterAnyCommandAsIfTheyHadNeverBeenStill) {
  World start = make_still_yard();
  EXPECT_EQ(start.step().still_bodies, 9U);
  const std::vector<std::byte> bytes = test::save(start, SnapshotKind::canonical);
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    World still = make_sleepless_world(), solved = make_sleepless_world();
    ASSERT_EQ(still.load(SnapshotKind::canonical, bytes), Status::ok);
    ASSERT_EQ(solved.load(SnapshotKind::canonical, bytes), Status::ok);
    test::Random random(seed);
    test::CommandDice dice(still, random, false);
    const Command command = dice.any();
    ASSERT_EQ(still.apply(command), solved.apply(command));
    for (int tick = 1; tick <= 4; ++tick) {
      wake_all(solved);
      EXPECT_EQ(solved.step().still_bodies, 0U);
      (void)still.step();
      EXPECT_LT(velocity_difference(still, solved), 1e-3)
          << "seed " << seed << ", command " << command.index() << ", tick " << tick;
    }
  }
}

// In each tick a copy is solved whole.
TEST(StillIslands, TakeEachStepAsSolvedOnesDoUnderManyCommands) {
  std::uint32_t still_bodies = 0;
  for (std::uint64_t seed = 1; seed <= test::share_of(std::uint64_t{24}); ++seed) {
    World still = make_still_yard(), solved = make_sleepless_world();
    test::Random random(seed);
    test::CommandDice dice(still, random, false);
    for (int tick = 0; tick < 400; ++tick) {
      for (int i = 0; tick % 20 == 0 && i < 2; ++i)
        (void)still.apply(dice.any());
      const std::vector<std::byte> bytes = test::save(still, SnapshotKind::canonical);
      ASSERT_EQ(solved.load(SnapshotKind::canonical, bytes), Status::ok);
      wake_all(solved);
      EXPECT_EQ(solved.step().still_bodies, 0U);
      still_bodies += still.step().still_bodies;
      ASSERT_LT(velocity_difference(still, solved), 1e-3) << "seed " << seed << ", tick " << tick;
    }
  }
  EXPECT_GT(still_bodies, test::share_of(1000U));
}

}  // namespace
}  // namespace lockstone
