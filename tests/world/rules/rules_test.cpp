// Rules as data: ignored pairs, surfaces of pairs and of tags, one-way bodies.
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/character.h>
#include <lockstone/rollback_history.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

constexpr Vec3<Unit> k_up{{}, Unit::from_integer(1), {}};
constexpr double k_gravity = 9.81;

World empty(std::uint16_t sleep_ms = 500) {
  return test::make_world({.body_capacity = 64, .sleep_ms = sleep_ms});
}

BodyDef box_at(Position x, Position y, Length half = 0.5_m) {
  BodyDef def = test::dynamic_body(Shape::box(half, half, half), {}, y, {});
  def.position.x = x;
  return def;
}

BodyDef floor(MotionType motion = MotionType::static_body) {
  BodyDef def;
  def.motion = motion;
  def.shape = Shape::box(20_m, 0.1_m, 20_m);
  return def;
}

BodyHandle add_platform(World& world, MotionType motion = MotionType::static_body) {
  const BodyHandle body = test::add(world, floor(motion));
  EXPECT_EQ(world.apply(SetOneWay{body, {.direction = k_up}}), Status::ok);
  return body;
}

double height(const World& world, BodyHandle body) {
  return metres(world.position(body).y);
}

PairSurface slippery(Coefficient friction) {
  return {.friction = friction, .restitution = {}, .rolling_resistance = {}};
}

std::vector<std::byte> canonical(const World& world) {
  std::vector<std::byte> bytes(world.snapshot_bytes_max(SnapshotKind::canonical));
  bytes.resize(world.save(SnapshotKind::canonical, bytes));
  return bytes;
}

// Ignored pairs -----------------------------------------------------------------------------------

TEST(PairRules, AnIgnoredBodyFallsThroughAndOthersDoNot) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  const BodyHandle ghost = test::add(world, box_at({}, 0.6_m));
  const BodyHandle other = test::add(world, box_at(5_m, 0.6_m));
  EXPECT_EQ(world.apply(SetPairRule{ground, ghost, {.collides = false}}), Status::ok);
  test::step(world, 60);
  EXPECT_NEAR(height(world, ghost), 0.6 - k_gravity / 2, 1e-6);  // free fall of a second
  EXPECT_NEAR(height(world, other), 0.6, 2e-3);
  EXPECT_FALSE(pair_rule_of(world, ghost, ground).collides);
  EXPECT_TRUE(pair_rule_of(world, other, ground).collides);
}

TEST(PairRules, AnIgnoredFastBodyIsNotStoppedOnItsWay) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  BodyDef def = box_at({}, 5_m, 0.1_m);
  def.velocity = {{}, -400_mps, {}};
  const BodyHandle bullet = test::add(world, def);
  EXPECT_EQ(world.apply(SetPairRule{bullet, ground, {.collides = false}}), Status::ok);
  test::step(world, 3);
  EXPECT_LT(height(world, bullet), -10);
}

TEST(PairRules, ARuleThatIsSetAndTakenBackWakesBothBodies) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  const BodyHandle box = test::add(world, box_at({}, 0.6_m));
  test::step(world, 200);
  ASSERT_TRUE(world.body(box).is_asleep);
  EXPECT_EQ(world.apply(SetPairRule{box, ground, {.collides = false}}), Status::ok);
  EXPECT_FALSE(world.body(box).is_asleep);
  test::step(world, 1);
  EXPECT_FALSE(world.touching(box, ground));
  EXPECT_EQ(world.apply(SetPairRule{ground, box, {}}), Status::ok);
  test::step(world, 60);
  EXPECT_NEAR(height(world, box), 0.6, 5e-3);
}

TEST(PairRules, GoWithEitherBody) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  const BodyHandle a = test::add(world, box_at({}, 0.6_m));
  const BodyHandle b = test::add(world, box_at(5_m, 0.6_m));
  EXPECT_EQ(world.apply(SetPairRule{a, ground, {.collides = false}}), Status::ok);
  EXPECT_EQ(world.apply(SetPairRule{a, b, {.collides = false}}), Status::ok);
  EXPECT_EQ(world.apply(DestroyBody{a}), Status::ok);
  const BodyHandle next = test::add(world, box_at({}, 0.6_m));
  ASSERT_EQ(next.index, a.index);
  EXPECT_TRUE(pair_rule_of(world, next, ground).collides);
  EXPECT_TRUE(pair_rule_of(world, next, b).collides);
  EXPECT_FALSE(world.find_fault());
}

TEST(PairRules, AreBounded) {
  World world = test::make_world({.body_capacity = 64});
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 40; ++i)
    bodies.push_back(test::add(world, box_at(Position::from_integer(3 * i), 5_m)));
  std::uint32_t count = 0;
  Status last = Status::ok;
  for (std::size_t i = 0; i < bodies.size() && last == Status::ok; ++i) {
    for (std::size_t j = 0; j < i && last == Status::ok; ++j) {
      last = world.apply(SetPairRule{bodies[i], bodies[j], {.collides = false}});
      count += last == Status::ok ? 1U : 0U;
    }
  }
  EXPECT_EQ(last, Status::capacity_exhausted);
  EXPECT_EQ(count, k_max_pair_rules);
  const StateHash before = world.hash();
  const Command one_more = SetPairRule{bodies[39], bodies[38], {.collides = false}};
  EXPECT_TRUE(static_cast<bool>(world.explain(one_more)));
  EXPECT_EQ(world.apply(one_more), Status::capacity_exhausted);
  EXPECT_EQ(world.hash().total, before.total);
  EXPECT_EQ(world.apply(SetPairRule{bodies[1], bodies[0], {}}), Status::ok);
  EXPECT_EQ(world.apply(one_more), Status::ok);
}

TEST(PairRules, OfABodyWithItselfAreRefused) {
  World world = empty();
  const BodyHandle box = test::add(world, box_at({}, 0.6_m));
  EXPECT_EQ(world.apply(SetPairRule{box, box, {.collides = false}}), Status::invalid_argument);
  EXPECT_EQ(world.apply(SetPairRule{box, {}, {.collides = false}}), Status::stale_handle);
}

TEST(Rules, LeaveTheHashAsItWasOnceTheyAreGone) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  const BodyHandle box = test::add(world, box_at({}, 0.6_m));
  const StateHash before = world.hash();
  EXPECT_EQ(world.apply(SetPairRule{box, ground, {.collides = false}}), Status::ok);
  EXPECT_EQ(world.apply(SetSurfaceRule{1, 2, slippery(0_r)}), Status::ok);
  EXPECT_EQ(world.apply(SetOneWay{ground, {.direction = k_up}}), Status::ok);
  EXPECT_NE(world.hash().total, before.total);
  EXPECT_EQ(world.apply(SetPairRule{ground, box, {}}), Status::ok);
  EXPECT_EQ(world.apply(SetSurfaceRule{2, 1, {}}), Status::ok);
  EXPECT_EQ(world.apply(SetOneWay{ground, {}}), Status::ok);
  EXPECT_EQ(world.hash().total, before.total);
}

// Surfaces ----------------------------------------------------------------------------------------

// v = v0 − μ g t
TEST(SurfaceRules, GiveTheFrictionOfTwoTags) {
  World world = empty();
  BodyDef ground = floor();
  ground.material.tag = 9;
  test::add(world, ground);
  BodyDef def = box_at({}, 0.6_m);
  def.velocity = {8_mps, {}, {}};
  const BodyHandle plain = test::add(world, def);
  def.position.z = 4_m;
  def.material.tag = 4;
  const BodyHandle tagged = test::add(world, def);
  EXPECT_EQ(world.apply(SetSurfaceRule{9, 4, slippery(0.1_r)}), Status::ok);
  test::step(world, 60);
  EXPECT_NEAR(metres_per_second(world.velocity(plain).x), 8 - 0.5 * k_gravity, 0.02);
  EXPECT_NEAR(metres_per_second(world.velocity(tagged).x), 8 - 0.1 * k_gravity, 0.02);
  ASSERT_TRUE(surface_rule_of(world, 4, 9));
  EXPECT_EQ(surface_rule_of(world, 4, 9)->friction, Coefficient(0.1_r));
  EXPECT_FALSE(surface_rule_of(world, 4, 4));
}

TEST(SurfaceRules, YieldToTheRuleOfAPair) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  BodyDef def = box_at({}, 0.6_m);
  def.velocity = {8_mps, {}, {}};
  const BodyHandle box = test::add(world, def);
  EXPECT_EQ(world.apply(SetSurfaceRule{0, 0, slippery(0.9_r)}), Status::ok);
  EXPECT_EQ(world.apply(SetPairRule{box, ground, {.surface = slippery(0_r)}}), Status::ok);
  test::step(world, 60);
  EXPECT_NEAR(metres_per_second(world.velocity(box).x), 8, 1e-3);
}

TEST(SurfaceRules, LetABallBounce) {
  World world = empty();
  const BodyHandle ground = test::add(world, floor());
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), {}, 5.6_m, {});
  const BodyHandle ball = test::add(world, def);
  const PairSurface elastic{.friction = {}, .restitution = 1_r, .rolling_resistance = {}};
  EXPECT_EQ(world.apply(SetPairRule{ball, ground, {.surface = elastic}}), Status::ok);
  double highest = 0;
  for (int i = 0; i < 130; ++i) {
    test::step(world, 1);
    if (i > 65) highest = std::max(highest, height(world, ball));
  }
  EXPECT_NEAR(highest, 5.6, 0.05);
}

TEST(SurfaceRules, AreRefusedOutOfRange) {
  World world = empty();
  const PairSurface wrong{
      .friction = Coefficient::max(), .restitution = {}, .rolling_resistance = {}};
  EXPECT_EQ(world.apply(SetSurfaceRule{0, 0, wrong}), Status::invalid_argument);
  EXPECT_TRUE(static_cast<bool>(world.explain(SetSurfaceRule{0, 0, wrong})));
  for (std::uint32_t i = 0; i < k_max_surface_rules; ++i)
    EXPECT_EQ(world.apply(SetSurfaceRule{i, i, slippery(0_r)}), Status::ok);
  EXPECT_EQ(world.apply(SetSurfaceRule{900, 900, slippery(0_r)}), Status::capacity_exhausted);
  EXPECT_TRUE(static_cast<bool>(world.explain(SetSurfaceRule{900, 900, slippery(0_r)})));
}

// One-way bodies ----------------------------------------------------------------------------------

class OneWayShapes : public ::testing::TestWithParam<Shape> {};

TEST_P(OneWayShapes, JumpThroughFromBelowAndLand) {
  World world = empty();
  add_platform(world);
  BodyDef def = test::dynamic_body(GetParam(), {}, -3_m, {});
  def.velocity = {{}, 12_mps, {}};
  def.fixed_rotation = true;
  const BodyHandle body = test::add(world, def);
  double highest = -10;
  for (int i = 0; i < 240; ++i) {
    test::step(world, 1);
    highest = std::max(highest, height(world, body));
  }
  EXPECT_NEAR(highest, -3 + 144 / (2 * k_gravity), 1e-2);  // nothing slowed it
  EXPECT_NEAR(height(world, body), 0.6, 5e-3);
  EXPECT_FALSE(world.find_fault());
}

INSTANTIATE_TEST_SUITE_P(Shapes, OneWayShapes,
                         ::testing::Values(Shape::box(0.5_m, 0.5_m, 0.5_m), Shape::sphere(0.5_m),
                                           Shape::capsule(0.25_m, 0.25_m),
                                           Shape::cylinder(0.5_m, 0.5_m)));

TEST(OneWayBodies, DoNotCatchABodyThatTurnsBackInside) {
  World world = empty();
  add_platform(world);
  BodyDef def = box_at({}, -1.6_m);
  def.velocity = {{}, Velocity::from_ratio(56, 10), {}};  // up by 1.6 m
  const BodyHandle body = test::add(world, def);
  double highest = -10;
  for (int i = 0; i < 120; ++i) {
    test::step(world, 1);
    highest = std::max(highest, height(world, body));
  }
  EXPECT_NEAR(highest, 0, 0.02);
  EXPECT_LT(height(world, body), -5);
}

// Displacement ends at 128 m, and its least value has no opposite.
TEST(OneWayBodies, LetABodyPassThatBeginsDeeperThanSeparationsReach) {
  World world = empty();
  BodyDef block = floor();
  block.shape = Shape::box(400_m, 400_m, 400_m);
  const BodyHandle ground = test::add(world, block);
  EXPECT_EQ(world.apply(SetOneWay{ground, {.direction = k_up}}), Status::ok);
  const BodyHandle body = test::add(world, box_at({}, 200_m));
  test::step(world, 60);
  EXPECT_NEAR(height(world, body), 200 - k_gravity / 2, 0.1);
}

TEST(OneWayBodies, StopFastBodiesFromTheFrontAlone) {
  for (const bool from_front : {true, false}) {
    World world = empty();
    add_platform(world);
    BodyDef def = box_at({}, from_front ? 9_m : -9_m, 0.1_m);
    def.velocity = {{}, from_front ? -300_mps : 300_mps, {}};
    const BodyHandle body = test::add(world, def);
    test::step(world, 30);
    if (from_front) {
      EXPECT_NEAR(height(world, body), 0.2, 5e-3);
    } else {
      EXPECT_GT(height(world, body), 100);
    }
  }
}

TEST(OneWayBodies, LetABodyPassAlongAWall) {
  World world = empty();
  BodyDef wall = floor();
  wall.shape = Shape::box(0.1_m, 5_m, 5_m);
  const BodyHandle gate = test::add(world, wall);
  const Vec3<Unit> along_x{Unit::from_integer(1), {}, {}};
  EXPECT_EQ(world.apply(SetOneWay{gate, {.direction = along_x, .tolerance = 45}}), Status::ok);
  BodyDef def = box_at(-4_m, {});
  def.gravity_scale = {};
  def.velocity = {6_mps, {}, {}};
  const BodyHandle with = test::add(world, def);
  def.position = {4_m, {}, 3_m};
  def.velocity = {-6_mps, {}, {}};
  const BodyHandle against = test::add(world, def);
  test::step(world, 120);
  EXPECT_NEAR(metres(world.position(with).x), -4 + 12, 1e-2);
  EXPECT_GT(metres(world.position(against).x), 0.59);
}

TEST(OneWayBodies, CarryABodyOverTheSeamOfAFloor) {
  World world = empty();
  BodyDef ground = floor();
  ground.shape = Shape::box(5_m, 0.1_m, 5_m);
  ground.position.x = -5_m;
  test::add(world, ground);
  ground.position.x = 5_m;
  const BodyHandle platform = test::add(world, ground);
  EXPECT_EQ(world.apply(SetOneWay{platform, {.direction = k_up}}), Status::ok);
  BodyDef def = box_at(-3_m, 0.6_m);
  def.velocity = {7_mps, {}, {}};
  def.material.friction = {};
  const BodyHandle body = test::add(world, def);
  test::step(world, 60);
  EXPECT_NEAR(metres(world.position(body).x), 4, 0.05);
  EXPECT_NEAR(height(world, body), 0.6, 5e-3);
}

TEST(OneWayBodies, LiftBodiesAsTheyRise) {
  World world = empty();
  BodyDef def = floor(MotionType::kinematic);
  def.velocity = {{}, 2_mps, {}};
  const BodyHandle lift = test::add(world, def);
  EXPECT_EQ(world.apply(SetOneWay{lift, {.direction = k_up}}), Status::ok);
  const BodyHandle body = test::add(world, box_at({}, 3_m));
  test::step(world, 180);
  EXPECT_NEAR(height(world, body), 6.6, 0.02);
}

TEST(OneWayBodies, AreStaticOrKinematic) {
  World world = empty();
  const BodyHandle box = test::add(world, box_at({}, 3_m));
  EXPECT_EQ(world.apply(SetOneWay{box, {.direction = k_up}}), Status::invalid_argument);
  const BodyHandle platform = add_platform(world);
  EXPECT_EQ(world.apply(SetOneWay{platform, {.direction = k_up, .tolerance = 91}}),
            Status::invalid_argument);
  EXPECT_EQ(one_way_of(world, platform), (OneWay{.direction = k_up, .tolerance = 60}));
  EXPECT_EQ(world.apply(SetMotionType{platform, MotionType::dynamic, {}}), Status::ok);
  EXPECT_EQ(one_way_of(world, platform), OneWay{});
  EXPECT_FALSE(world.find_fault());
}

TEST(OneWayBodies, KeepTheirDirectionToAThirdOfADegree) {
  World world = empty();
  const BodyHandle platform = add_platform(world);
  for (int i = 0; i < 500; ++i) {
    const double angle = 0.7 * i, lean = std::cos(0.9 * i);
    const double wanted[] = {std::cos(angle), lean, std::sin(angle)};
    const double length = std::sqrt(1 + lean * lean);
    Vec3<Unit> direction;
    for (int axis = 0; axis < 3; ++axis)
      direction[axis].raw = static_cast<std::int32_t>(std::lround(wanted[axis] * (1 << 29)));
    ASSERT_EQ(world.apply(SetOneWay{platform, {.direction = direction}}), Status::ok);
    const Vec3<Unit> kept = one_way_of(world, platform).direction;
    double dot = 0;
    for (int axis = 0; axis < 3; ++axis)
      dot += std::ldexp(kept[axis].raw, -30) * wanted[axis] / length;
    EXPECT_GT(dot, std::cos(3.14159265 / 3 / 180));
  }
}

// A body half through keeps passing after the state was saved and loaded elsewhere.
TEST(OneWayBodies, PassOnAfterASnapshot) {
  World world = empty();
  add_platform(world);
  BodyDef def = box_at({}, -1.6_m);
  def.velocity = {{}, Velocity::from_ratio(56, 10), {}};
  test::add(world, def);
  test::step(world, 34);  // it turns back inside
  World other = empty();
  ASSERT_EQ(other.load(SnapshotKind::canonical, canonical(world)), Status::ok);
  EXPECT_EQ(other.hash().total, world.hash().total);
  for (int i = 0; i < 60; ++i) {
    test::step(world, 1);
    test::step(other, 1);
    other.drop_derived();
    ASSERT_EQ(other.hash().total, world.hash().total) << i;
  }
}

// Characters --------------------------------------------------------------------------------------

TEST(OneWayBodies, LetACharacterJumpThroughAndStand) {
  World world = empty();
  add_platform(world);
  const CharacterDef character;
  Vec3<Position> at{{}, -2_m, {}};
  Length rise = Length::from_ratio(15, 100);  // 9 m/s
  double highest = -10;
  CharacterMove move;
  for (int i = 0; i < 150; ++i) {
    move = move_character(world, character, at, {{}, rise, {}}, false);
    at = move.position;
    highest = std::max(highest, metres(at.y));
    rise = move.grounded ? Length{} : rise - Length::from_ratio(981, 360000);
  }
  EXPECT_GT(highest, 1.7);
  EXPECT_TRUE(move.grounded);
  EXPECT_NEAR(metres(at.y), 0.1 + 0.9 + 0.01, 2e-3);
}

TEST(OneWayBodies, LetACharacterFallOutThatTurnsBackInside) {
  World world = empty();
  add_platform(world);
  const CharacterDef character;
  Vec3<Position> at{{}, {}, {}};
  for (int i = 0; i < 60; ++i)
    at = move_character(world, character, at, {{}, Length::from_ratio(-1, 20), {}}).position;
  EXPECT_NEAR(metres(at.y), -3, 1e-3);
  EXPECT_TRUE(has_room(world, character, {}));
}

}  // namespace
}  // namespace lockstone
