// The rules and the bots: players move, carry, score, fall and return.
#include <set>

#include <gtest/gtest.h>

#include "tests/tools/arena/arena_match.h"
#include "tools/arena/level.h"
#include "tools/arena/motion.h"
#include "tools/arena/tags.h"

namespace lockstone::arena::test {
namespace {

/// A match of one player whose input the test writes.
class Solo {
 public:
  explicit Solo(const ArenaConfig& config) : simulation(config) {}

  void play(int ticks, const Input& input, InputOrigin origin = InputOrigin::received) {
    for (int i = 0; i < ticks; ++i) {
      TickInputs inputs;
      input.encode(inputs.bytes(0));
      inputs.set_origin(0, origin);
      simulation.step(inputs.view(1));
    }
  }
  [[nodiscard]] const PlayerRecord& player() const { return simulation.arena().state.players[0]; }
  [[nodiscard]] World& world() { return simulation.arena_for_tests().world; }
  [[nodiscard]] Vec3<Position> place() { return world().position(player().body); }
  void put(BodyHandle body, std::int64_t x_mm, std::int64_t y_mm, std::int64_t z_mm) {
    const Vec3<Position> at{millimetres(x_mm), millimetres(y_mm), millimetres(z_mm)};
    ASSERT_EQ(world().apply(Teleport{body, at, Quat{}}), Status::ok);
    ASSERT_EQ(world().apply(SetVelocity{body, {}}), Status::ok);
  }

  ArenaSimulation simulation;
};

constexpr ArenaConfig k_alone{
    .seed = 1, .loose_bodies = 0, .players = 1, .variant = Variant::empty};
constexpr ArenaConfig k_with_crate{
    .seed = 1, .loose_bodies = 1, .players = 1, .variant = Variant::empty};

TEST(ArenaRules, APlayerWalksWhereTheStickPoints) {
  Solo solo(k_alone);
  solo.play(90, {});
  const Vec3<Position> before = solo.place();
  solo.play(60, {.move_x = -127});
  const Vec3<Position> after = solo.place();
  EXPECT_LT(after.x, before.x - millimetres(4500));
  EXPECT_LT(abs(after.z - before.z), millimetres(50));
}

TEST(ArenaRules, AnAbsentPlayerStandsStill) {
  Solo solo(k_alone);
  solo.play(90, {.move_x = 127}, InputOrigin::absent);
  const Vec3<Position> before = solo.place();
  solo.play(60, {.move_x = 127, .buttons = k_jump}, InputOrigin::absent);
  EXPECT_LT(abs(solo.place().x - before.x), millimetres(5));
  EXPECT_LT(abs(solo.place().y - before.y), millimetres(5));
}

TEST(ArenaRules, APlayerJumpsFromTheGroundOnly) {
  Solo solo(k_alone);
  solo.play(90, {});
  const Position ground = solo.place().y;
  Position top = ground;
  for (int i = 0; i < 60; ++i) {
    solo.play(1, {.buttons = k_jump});
    top = max(top, solo.place().y);
  }
  EXPECT_GT(top, ground + millimetres(1000));
  EXPECT_LT(top, ground + millimetres(2000));
}

TEST(ArenaRules, ACarriedCrateIsThrownIntoTheGoalForAPoint) {
  Solo solo(k_with_crate);
  solo.play(60, {});
  const BodyHandle crate = solo.simulation.arena().level.loose[0];
  solo.put(solo.player().body, 10'000, 900, 0);
  solo.put(crate, 11'200, 500, 0);
  solo.play(2, {});
  solo.play(40, {.buttons = k_grab});
  EXPECT_EQ(solo.player().held, crate);
  EXPECT_GT(solo.world().position(crate).y, millimetres(900));
  solo.play(120, {});
  EXPECT_TRUE(solo.player().held.is_null());
  EXPECT_EQ(solo.player().score, 1);
  EXPECT_EQ(solo.simulation.arena().state.game.goals, 1U);
  EXPECT_EQ(tag_of(solo.world(), crate).owner, 0);
}

TEST(ArenaRules, APushMovesTheBodyInFront) {
  Solo solo(k_with_crate);
  solo.play(60, {});
  const BodyHandle crate = solo.simulation.arena().level.loose[0];
  solo.put(solo.player().body, 0, 900, 0);
  solo.put(crate, 0, 500, 1200);
  solo.play(2, {});
  solo.play(30, {.yaw = 16384, .buttons = k_push});
  EXPECT_GT(solo.world().position(crate).z, millimetres(1800));
  EXPECT_EQ(tag_of(solo.world(), crate).owner, 1);
}

TEST(ArenaCharacters, PushTheCratesThatStopThem) {
  Solo solo(k_with_crate);
  solo.play(60, {});
  const BodyHandle crate = solo.simulation.arena().level.loose[0];
  solo.put(solo.player().body, 0, 900, 8'000);
  solo.put(crate, -1'200, 500, 8'000);
  solo.play(60, {.move_x = -127});
  EXPECT_LT(solo.world().position(crate).x, millimetres(-2'500));
  EXPECT_LT(solo.place().x, millimetres(-1'500));
  EXPECT_GT(solo.place().x, solo.world().position(crate).x + millimetres(600));
  EXPECT_EQ(tag_of(solo.world(), crate).owner, 1);
}

TEST(ArenaCharacters, AreCarriedByTheFerry) {
  Solo solo({.seed = 1, .loose_bodies = 0, .players = 1});
  const BodyHandle ferry = solo.simulation.arena().level.ferry;
  solo.put(solo.player().body, -11'000, 1'500, 4'000);
  solo.play(20, {});
  const Vec3<Position> before = solo.world().position(ferry);
  const Position beside = solo.place().z - before.z;
  solo.play(300, {});  // it turns back, and the player slips until it has the ferry's speed
  EXPECT_GT(abs(solo.world().position(ferry).z - before.z), millimetres(1'000));
  EXPECT_LT(abs(solo.place().z - solo.world().position(ferry).z - beside), millimetres(120));
}

TEST(ArenaCharacters, ScoreForTheHillThatTheyHold) {
  Solo solo({.seed = 1, .loose_bodies = 0, .players = 1});
  solo.put(solo.player().body, 0, 2'500, 0);
  solo.play(190, {});
  EXPECT_EQ(solo.player().score, 3);
}

// 13.4 kg at 17 m/s, into 80 kg.
TEST(ArenaCharacters, AreKnockedByTheImpulseOfASnowball) {
  ArenaSimulation game({.seed = 1, .loose_bodies = 0, .players = 2, .variant = Variant::empty});
  World& world = game.arena_for_tests().world;
  const auto& players = game.arena().state.players;
  for (const std::size_t slot : {0U, 1U}) {
    const Vec3<Position> at{millimetres(slot == 0 ? 0 : 2'500), millimetres(900), {}};
    ASSERT_EQ(world.apply(Teleport{players[slot].body, at, Quat{}}), Status::ok);
  }
  SolverVelocity fastest{};
  for (int tick = 0; tick < 30; ++tick) {
    TickInputs inputs;
    Input{.buttons = static_cast<std::uint8_t>(tick == 2 ? k_shoot : 0)}.encode(inputs.bytes(0));
    Input{}.encode(inputs.bytes(1));
    for (const std::size_t slot : {0U, 1U})
      inputs.set_origin(slot, InputOrigin::received);
    game.step(inputs.view(2));
    fastest = max(fastest, players[1].velocity.x);
  }
  EXPECT_GT(fastest, SolverVelocity::from_ratio(23, 10));
  EXPECT_LT(fastest, SolverVelocity::from_ratio(33, 10));
  EXPECT_GT(world.position(players[1].body).x, millimetres(2'530));
  EXPECT_EQ(players[1].rival, 1);
}

TEST(ArenaRules, ASnowballMelts) {
  Solo solo(k_alone);
  solo.play(60, {});
  const std::uint32_t bodies = solo.world().body_count();
  solo.play(1, {.buttons = k_shoot});
  EXPECT_EQ(solo.world().body_count(), bodies + 1);
  solo.play(250, {});
  EXPECT_EQ(solo.world().body_count(), bodies);
}

TEST(ArenaRules, WhoFallsLosesAPointAndReturns) {
  Solo solo(k_alone);
  solo.put(solo.player().body, 30'000, 1000, 0);
  solo.play(150, {});
  EXPECT_EQ(solo.player().score, -1);
  EXPECT_EQ(solo.simulation.arena().state.game.falls, 1U);
  solo.play(120, {});
  EXPECT_EQ(solo.player().respawn_ticks, 0);
  EXPECT_GT(solo.place().y, Position{});
}

constexpr ArenaConfig k_alone_in_the_yard{.seed = 1, .loose_bodies = 0, .players = 1};

// Beside the buggy, which looks along -x, and in it.
Solo in_the_buggy() {
  Solo solo(k_alone_in_the_yard);
  solo.play(60, {});
  solo.put(solo.player().body, 13'000, 900, 13'500);
  solo.play(1, {.buttons = k_ride});
  EXPECT_EQ(solo.simulation.arena().state.game.driver, 1U);
  return solo;
}

TEST(ArenaBuggy, IsDrivenWhereTheStickPoints) {
  Solo solo = in_the_buggy();
  const BodyHandle buggy = solo.simulation.arena().level.buggy;
  solo.play(90, {.move_x = -127});
  EXPECT_LT(solo.world().velocity(buggy).x, Velocity::from_integer(-4));
  EXPECT_LT(solo.world().position(buggy).x, millimetres(10'000));
  solo.play(90, {.move_z = -127});
  EXPECT_LT(solo.world().velocity(buggy).z, Velocity::from_integer(-3));
  const Vec3<Length> apart = offset_between(solo.world().position(buggy), solo.place());
  EXPECT_LT(squared_raw(apart), squared_raw({millimetres_long(1500), {}, {}}));
  solo.play(200, {});
  EXPECT_LT(abs(solo.world().velocity(buggy).z), Velocity::from_ratio(1, 10));
}

TEST(ArenaBuggy, IsLeftByThePlayerAndStands) {
  Solo solo = in_the_buggy();
  const BodyHandle buggy = solo.simulation.arena().level.buggy;
  solo.play(40, {.move_x = -127});
  solo.play(1, {.buttons = k_ride});
  EXPECT_EQ(solo.simulation.arena().state.game.driver, 0U);
  solo.play(180, {});
  EXPECT_LT(abs(solo.world().velocity(buggy).x), Velocity::from_ratio(1, 10));
  EXPECT_GT(solo.place().y, millimetres(800));
  const Vec3<Position> before = solo.place();
  solo.play(60, {.move_x = -127});
  EXPECT_LT(solo.place().x, before.x - millimetres(4000));  // on foot, and it meets the ground
}

TEST(ArenaBuggy, IsLeftByAPlayerWhoIsGone) {
  Solo solo = in_the_buggy();
  solo.play(1, {}, InputOrigin::absent);
  EXPECT_EQ(solo.simulation.arena().state.game.driver, 0U);
}

TEST(ArenaBuggy, ComesBackAfterItFell) {
  Solo solo = in_the_buggy();
  const BodyHandle buggy = solo.simulation.arena().level.buggy;
  solo.put(buggy, 30'000, 1000, 0);
  solo.play(150, {});
  EXPECT_EQ(solo.simulation.arena().state.game.driver, 0U);
  EXPECT_EQ(solo.player().score, -1);
  solo.play(60, {});
  const Vec3<Length> apart = offset_between(buggy_def().position, solo.world().position(buggy));
  EXPECT_LT(squared_raw(apart), squared_raw({millimetres_long(500), {}, {}}));
}

TEST(ArenaBuggy, StandsUpAgain) {
  Solo solo(k_alone_in_the_yard);
  solo.play(60, {});
  const BodyHandle buggy = solo.simulation.arena().level.buggy;
  const Quat on_its_back{Unit::from_integer(1), {}, {}, {}};
  ASSERT_EQ(solo.world().apply(
                Teleport{buggy, {{}, millimetres(2500), millimetres(14'000)}, on_its_back}),
            Status::ok);
  solo.play(300, {});
  EXPECT_GT(to_matrix(pose_of(solo.world(), buggy).orientation).y.y, Unit::from_ratio(9, 10));
}

TEST(ArenaBuggy, ClaimsTheCratesThatItHits) {
  Solo solo({.seed = 1, .loose_bodies = 1, .players = 1});
  solo.play(60, {});
  const BodyHandle crate = solo.simulation.arena().level.loose[0];
  solo.put(crate, 7'000, 500, 15'000);
  solo.put(solo.player().body, 13'000, 900, 13'500);
  solo.play(1, {.buttons = k_ride});
  solo.play(120, {.move_x = -127});
  EXPECT_EQ(tag_of(solo.world(), crate).owner, 1);
}

TEST(ArenaIntegers, HeadingsAgreeWithTheirDirections) {
  for (int yaw = -32768; yaw < 32768; yaw += 97) {
    const Vec3<Unit> direction = direction_of(static_cast<std::int16_t>(yaw));
    const int back = yaw_of(direction.x.raw, direction.z.raw);
    const auto error = static_cast<std::int16_t>(static_cast<std::uint16_t>(back - yaw));
    EXPECT_LE(std::abs(error), 55) << yaw;  // 0.3°
  }
}

TEST(ArenaIntegers, SpeedsAreShortenedToTheLimit) {
  const SolverVelocity limit = SolverVelocity::from_integer(6);
  const Vec3<SolverVelocity> fast{
      SolverVelocity::from_integer(300), SolverVelocity::from_integer(-400), {}};
  const Vec3<SolverVelocity> slow = shortened(fast, limit);
  EXPECT_NEAR(slow.x.raw, SolverVelocity::from_ratio(36, 10).raw, 400);
  EXPECT_NEAR(slow.y.raw, SolverVelocity::from_ratio(-48, 10).raw, 400);
  EXPECT_EQ(shortened(slow, SolverVelocity::from_integer(7)), slow);
}

/// The deeds of the bots in one match.
struct Deeds {
  int ridden = 0;  // ticks in the buggy
  std::set<std::uint64_t> inputs;
  std::uint8_t buttons = 0;
  std::int64_t farthest = 0;  // squared, see squared_raw
};

TEST(ArenaBots, MovePressEverythingAndScore) {
  ArenaSimulation simulation({.seed = 8});
  std::array<Deeds, 4> deeds{};
  for (int tick = 0; tick < 1800; ++tick) {
    step_with_bots(simulation, 7);
    for (std::size_t slot = 0; slot < deeds.size(); ++slot) {
      const Input input = bot_input(simulation.arena(), 7, slot);
      deeds[slot].inputs.insert(static_cast<std::uint16_t>(input.yaw) | std::uint64_t{input.buttons}
                                                                            << 16);
      deeds[slot].buttons |= input.buttons;
      deeds[slot].ridden += simulation.arena().state.game.driver == slot + 1 ? 1 : 0;
      const BodyHandle body = simulation.arena().state.players[slot].body;
      const std::int64_t way =
          squared_raw(offset_between(spawn_point(slot), simulation.arena().world.position(body)));
      deeds[slot].farthest = std::max(deeds[slot].farthest, way);
    }
  }
  std::int32_t points = 0;
  int ridden = 0;
  for (std::size_t slot = 0; slot < deeds.size(); ++slot) {
    ridden += deeds[slot].ridden;
    EXPECT_GT(deeds[slot].inputs.size(), 100U);
    EXPECT_EQ(deeds[slot].buttons & (k_jump | k_push | k_grab), k_jump | k_push | k_grab);
    EXPECT_GT(deeds[slot].farthest, squared_raw({millimetres_long(6000), {}, {}}));
    points += simulation.arena().state.players[slot].score;
  }
  EXPECT_GT(simulation.arena().state.game.goals, 3U);
  EXPECT_GT(points, 5);
  EXPECT_GT(ridden, 200);
}

TEST(ArenaBots, PlayTheSameOnTheSameView) {
  ArenaSimulation a({}), b({});
  for (int tick = 0; tick < 100; ++tick)
    step_with_bots(a);
  ASSERT_EQ(b.load(SnapshotKind::canonical, saved(a, SnapshotKind::canonical)), Status::ok);
  for (std::size_t slot = 0; slot < 4; ++slot) {
    std::array<std::byte, k_input_bytes> here{}, there{};
    bot_input(a.arena(), 1, slot).encode(here);
    bot_input(b.arena(), 1, slot).encode(there);
    EXPECT_EQ(here, there);
  }
}

TEST(Arena, HoldsSixteenPlayers) {
  ArenaSimulation simulation({.seed = 4, .loose_bodies = 216, .players = 16});
  for (int tick = 0; tick < 400; ++tick)
    step_with_bots(simulation);
  EXPECT_EQ(simulation.last_report().status, Status::ok);
  for (std::size_t slot = 0; slot < 16; ++slot) {
    EXPECT_TRUE(simulation.arena().world.exists(simulation.arena().state.players[slot].body));
  }
}

}  // namespace
}  // namespace lockstone::arena::test
