// Every field of the game's state is saved, hashed and named.
#include <gtest/gtest.h>

#include "tests/tools/arena/arena_match.h"
#include "tools/arena/state_codec.h"
#include "tools/arena/tags.h"

namespace lockstone::arena::test {
namespace {

constexpr std::size_t k_header_bytes = 8;

std::size_t encoded_bytes(std::size_t players) {
  std::array<std::byte, k_max_state_bytes> bytes;
  ByteWriter writer(bytes);
  encode_state({}, players, writer);
  EXPECT_TRUE(writer.ok());
  return writer.size();
}

BodyHandle body_named(const World& world, const std::string& name) {
  for (std::uint32_t index = 0; index < world.body_limit(); ++index) {
    const BodyHandle body = world.body_at(index);
    if (!body.is_null() && tag_of(world, body).name() == name) return body;
  }
  return {};
}

// Runs `change` on one of two equal games and describes them.
template <class Change>
StateDifference difference_after(Change change) {
  ArenaSimulation here({}), there({});
  for (int tick = 0; tick < 90; ++tick) {
    step_with_bots(here);
    step_with_bots(there);
  }
  change(here.arena_for_tests());
  return here.describe(saved(here, SnapshotKind::canonical), saved(there, SnapshotKind::canonical));
}

TEST(ArenaState, IsHashedAndKeptByteForByte) {
  const ArenaConfig config{.loose_bodies = 10, .players = 2};
  ArenaSimulation simulation(config);
  for (int tick = 0; tick < 30; ++tick)
    step_with_bots(simulation);
  const std::vector<std::byte> good = saved(simulation, SnapshotKind::canonical);
  const std::uint64_t hash = simulation.hash();
  const std::size_t end = k_header_bytes + encoded_bytes(config.players);
  for (std::size_t at = k_header_bytes; at < end; ++at) {
    std::vector<std::byte> bytes = good;
    bytes[at] ^= std::byte{1};
    if (simulation.load(SnapshotKind::canonical, bytes) != Status::ok) continue;
    EXPECT_NE(simulation.hash(), hash) << "byte " << at;
    EXPECT_EQ(saved(simulation, SnapshotKind::canonical), bytes) << "byte " << at;
  }
}

TEST(ArenaState, EncodesAndDecodesToTheSame) {
  ArenaSimulation simulation({});
  for (int tick = 0; tick < 200; ++tick)
    step_with_bots(simulation);
  std::array<std::byte, k_max_state_bytes> bytes;
  ByteWriter writer(bytes);
  encode_state(simulation.arena().state, 4, writer);
  ByteReader reader(writer.written());
  const Result<GameState> decoded = decode_state(4, reader);
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(decoded.value(), simulation.arena().state);
  EXPECT_EQ(reader.remaining(), 0U);
}

TEST(ArenaDescribe, NamesNothingForEqualStates) {
  EXPECT_FALSE(difference_after([](Arena&) {}).differs);
}

TEST(ArenaDescribe, NamesAPlayersField) {
  const StateDifference difference =
      difference_after([](Arena& arena) { arena.state.players[2].score ^= 1; });
  EXPECT_TRUE(difference.differs);
  EXPECT_EQ(difference.store, "player");
  EXPECT_EQ(difference.object, 2U);
  EXPECT_EQ(difference.field, "score");
  EXPECT_EQ(difference.here.size(), 10U);
}

TEST(ArenaDescribe, NamesAShotsHandle) {
  const StateDifference difference =
      difference_after([](Arena& arena) { arena.state.shots[5].body.generation ^= 4; });
  EXPECT_EQ(difference.store, "shot");
  EXPECT_EQ(difference.object, 5U);
  EXPECT_EQ(difference.field, "body.generation");
}

TEST(ArenaDescribe, NamesBodyAndFieldOfOneFlippedBit) {
  std::uint64_t index = 0;
  const StateDifference difference = difference_after([&](Arena& arena) {
    const BodyHandle body = body_named(arena.world, "crate 18");
    index = body.index;
    Vec3<Velocity> velocity = arena.world.velocity(body);
    velocity.y.raw ^= 1;
    ASSERT_EQ(arena.world.apply(SetVelocity{body, velocity}), Status::ok);
  });
  EXPECT_TRUE(difference.differs);
  EXPECT_EQ(difference.store, "body");
  EXPECT_EQ(difference.object, index);
  EXPECT_EQ(difference.name, "crate 18");
  EXPECT_EQ(difference.field, "velocity.y");
}

TEST(ArenaDescribe, AnswersForBytesThatAreNoSnapshot) {
  ArenaSimulation simulation({});
  const std::vector<std::byte> good = saved(simulation, SnapshotKind::canonical);
  const StateDifference difference = simulation.describe(good, ByteView(good).first(6));
  EXPECT_TRUE(difference.differs);
  EXPECT_EQ(difference.there, "truncated");
}

}  // namespace
}  // namespace lockstone::arena::test
