// The arena as a simulation: reproducible, saved whole, safe with any input.
#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/tools/arena/arena_match.h"
#include "tools/arena/arena_command.h"
#include "tools/arena/level.h"

namespace lockstone::arena::test {
namespace {

constexpr int k_ticks = 300;

std::vector<std::uint64_t> hashes_of_match(const ArenaConfig& config, int ticks) {
  ArenaSimulation simulation(config);
  std::vector<std::uint64_t> hashes{simulation.hash()};
  for (int tick = 0; tick < ticks; ++tick) {
    step_with_bots(simulation);
    hashes.push_back(simulation.hash());
  }
  return hashes;
}

// Steps `plain` and a second game that is saved and loaded before each tick.
void expect_reloading_changes_nothing(SnapshotKind kind) {
  const ArenaConfig config{.seed = 3};
  ArenaSimulation plain(config), reloaded(config), other(config);
  for (int tick = 0; tick < k_ticks; ++tick) {
    ASSERT_EQ(other.load(kind, saved(reloaded, kind)), Status::ok);
    ASSERT_EQ(reloaded.load(kind, saved(other, kind)), Status::ok);
    step_with_bots(plain);
    step_with_bots(reloaded);
    ASSERT_EQ(plain.hash(), reloaded.hash()) << "after tick " << tick;
  }
}

TEST(ArenaConfig, ComesBackFromItsBytes) {
  const ArenaConfig config{
      .seed = 0x123456789abcdef0, .loose_bodies = 40, .players = 16, .variant = Variant::empty};
  const Result<ArenaConfig> decoded = ArenaConfig::decode(config.encode());
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(decoded.value(), config);
}

TEST(ArenaConfig, RefusesBytesThatAreNoConfiguration) {
  auto bytes = ArenaConfig{}.encode();
  EXPECT_EQ(ArenaConfig::decode(ByteView(bytes).first(17)).status(), Status::truncated);
  bytes[4] = std::byte{9};
  EXPECT_EQ(ArenaConfig::decode(bytes).status(), Status::unsupported_version);
  bytes = ArenaConfig{}.encode();
  bytes[0] = std::byte{0};
  EXPECT_EQ(ArenaConfig::decode(bytes).status(), Status::malformed);
  bytes = ArenaConfig{}.encode();
  bytes[16] = std::byte{k_max_players + 1};  // players
  EXPECT_EQ(ArenaConfig::decode(bytes).status(), Status::invalid_argument);
  EXPECT_EQ(make_arena(bytes).status(), Status::invalid_argument);
}

TEST(Arena, GivesTheSameHashesForTheSameInputs) {
  EXPECT_EQ(hashes_of_match({.seed = 5}, k_ticks), hashes_of_match({.seed = 5}, k_ticks));
}

TEST(Arena, DiffersFromSeedToSeed) {
  EXPECT_NE(hashes_of_match({.seed = 5}, 1), hashes_of_match({.seed = 6}, 1));
}

TEST(Arena, GoesOnTheSameAfterACanonicalSnapshot) {
  expect_reloading_changes_nothing(SnapshotKind::canonical);
}

TEST(Arena, GoesOnTheSameAfterANativeSnapshot) {
  expect_reloading_changes_nothing(SnapshotKind::native);
}

TEST(Arena, GoesOnTheSameAfterDerivedDataIsDropped) {
  ArenaSimulation plain({}), dropped({});
  for (int tick = 0; tick < k_ticks; ++tick) {
    dropped.arena_for_tests().world.drop_derived();
    step_with_bots(plain);
    step_with_bots(dropped);
    ASSERT_EQ(plain.hash(), dropped.hash()) << "after tick " << tick;
  }
}

TEST(Arena, AcceptsAnyInputBytesAndOrigins) {
  const std::uint64_t seed = lockstone::test::run_seed();
  const ArenaConfig config{.seed = seed, .loose_bodies = 80, .players = 16};
  ArenaSimulation first(config), second(config);
  Random random(seed);
  for (int tick = 0; tick < 400; ++tick) {
    TickInputs inputs;
    inputs.press_anything(random);
    first.step(inputs.view(config.players));
    second.step(inputs.view(config.players));
    ASSERT_EQ(first.hash(), second.hash()) << "after tick " << tick;
    ASSERT_EQ(second.load(SnapshotKind::canonical, saved(first, SnapshotKind::canonical)),
              Status::ok);
  }
}

TEST(Arena, StaysAsItIsWhenASnapshotIsBad) {
  const std::uint64_t seed = lockstone::test::run_seed();
  ArenaSimulation simulation({.loose_bodies = 30, .players = 2});
  for (int tick = 0; tick < 60; ++tick)
    step_with_bots(simulation);
  const std::vector<std::byte> good = saved(simulation, SnapshotKind::canonical);
  const std::uint64_t hash = simulation.hash();
  Random random(seed);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::byte> bad = good;
    bad.resize(random.below(static_cast<std::uint32_t>(good.size())));
    ASSERT_NE(simulation.load(SnapshotKind::canonical, bad), Status::ok) << bad.size() << " bytes";
    ASSERT_EQ(simulation.hash(), hash);
  }
}

// A snapshot may come from a hostile peer: an accepted one must then run.
TEST(Arena, SurvivesWhateverSnapshotItAccepts) {
  const std::uint64_t seed = lockstone::test::run_seed();
  const ArenaConfig config{.loose_bodies = 30, .players = 4};
  ArenaSimulation start(config), simulation(config);
  for (int tick = 0; tick < 120; ++tick)
    step_with_bots(start);
  const std::vector<std::byte> good = saved(start, SnapshotKind::canonical);
  Random random(seed);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::byte> bytes = good;
    for (int flips = 0; flips < 3; ++flips) {
      const std::uint32_t at = random.below(static_cast<std::uint32_t>(bytes.size()));
      bytes[at] ^= static_cast<std::byte>(1U << random.below(8));
    }
    if (simulation.load(SnapshotKind::canonical, bytes) != Status::ok) continue;
    for (int tick = 0; tick < 5; ++tick)
      step_with_bots(simulation);
  }
}

TEST(ArenaCommands, GiveAPointAndLeaveChatToPeople) {
  ArenaSimulation game(ArenaConfig{.loose_bodies = 0, .players = 3});
  const std::uint64_t before = game.hash();
  game.command({1, chat_command("hello")});
  game.command({1, gift_command(3)});              // no such slot
  game.command({k_server_slot, gift_command(0)});  // the server has no points
  EXPECT_EQ(game.hash(), before);
  game.command({1, gift_command(2)});
  EXPECT_EQ(game.arena().state.players[1].score, -1);
  EXPECT_EQ(game.arena().state.players[2].score, 1);
  EXPECT_EQ(chat_text(chat_command("Zo\u00eb")), "Zo\u00eb");
  EXPECT_FALSE(chat_text(chat_command("a\nb")).has_value());
  EXPECT_FALSE(chat_text(gift_command(2)).has_value());
}

TEST(ArenaLevel, Has64PlacesToStartFromOnTheField) {
  for (std::size_t slot = 0; slot < k_max_players; ++slot) {
    const Vec3<Position> place = spawn_point(slot);
    EXPECT_LT(abs(place.x), Position::from_integer(20));
    EXPECT_LT(abs(place.z), Position::from_integer(20));
    for (std::size_t other = 0; other < slot; ++other)
      EXPECT_FALSE(spawn_point(other) == place) << slot;
  }
}

}  // namespace
}  // namespace lockstone::arena::test
