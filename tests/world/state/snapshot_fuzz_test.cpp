// Snapshots from anywhere: a valid world, or a typed error and the old world untouched.

#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "core/world/state/snapshot_format.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using Bytes = std::vector<std::byte>;

World saved_world() {
  World world = test::make_world();
  test::fill_with_random_bodies(world, 7, 40);
  test::step(world, 60);
  return world;
}

void reseal(Bytes& bytes) {
  const std::span<std::byte> all(bytes);
  ByteWriter(all.last(8)).put(hash64(all.first(all.size() - 8)));
}

// Mostly in records, now and then in the frame; sometimes whole words, which get extreme values.
void mutate(Bytes& bytes, test::Random& random) {
  constexpr std::uint64_t k_words[] = {0, ~std::uint64_t{0}, std::uint64_t{1} << 63,
                                       (std::uint64_t{1} << 63) - 1, 0x8000000080000000U};
  const std::size_t count = 1 + random.below(20);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = random.below(bytes.size() - 8);
    if (random.next() % 4 != 0) {
      bytes[place] ^= static_cast<std::byte>(1U << random.below(8));
      continue;
    }
    ByteWriter(std::span(bytes).subspan(place / 4 * 4)).put(k_words[random.below(5)]);
  }
  reseal(bytes);
}

// Operations that must work on every accepted world.
void expect_lives(World& world) {
  for (int tick = 0; tick < 20; ++tick)
    static_cast<void>(world.step());
  const Bytes saved = test::save(world, SnapshotKind::canonical);
  World copy = test::make_world();
  ASSERT_EQ(copy.load(SnapshotKind::canonical, saved), Status::ok) << "a world left its own range";
  EXPECT_EQ(copy.hash().total, world.hash().total);
}

TEST(CanonicalSnapshot, MutatedIsRefusedWholeOrLives) {
  const World source = saved_world();
  const Bytes good = test::save(source, SnapshotKind::canonical);
  test::Random random;
  World world = test::make_world();
  ASSERT_EQ(world.load(SnapshotKind::canonical, good), Status::ok);
  const std::uint64_t before = world.hash().total;
  int accepted = 0;
  constexpr int k_rounds = test::share_of(400);
  for (int i = 0; i < k_rounds; ++i) {
    Bytes bytes = good;
    mutate(bytes, random);
    if (world.load(SnapshotKind::canonical, bytes) != Status::ok) {
      ASSERT_EQ(world.hash().total, before) << "a refused snapshot left something behind";
      continue;
    }
    ++accepted;
    EXPECT_EQ(test::save(world, SnapshotKind::canonical), bytes) << "loaded something else";
    expect_lives(world);
    ASSERT_EQ(world.load(SnapshotKind::canonical, good), Status::ok);
  }
  EXPECT_LT(accepted, k_rounds);
}

TEST(CanonicalSnapshot, OneFlippedBitThatIsLetInLives) {
  const World source = saved_world();
  const Bytes good = test::save(source, SnapshotKind::canonical);
  test::Random random;
  World world = test::make_world();
  int accepted = 0;
  constexpr int k_rounds = test::share_of(200);
  for (int i = 0; i < k_rounds; ++i) {
    Bytes bytes = good;
    bytes[random.below(bytes.size() - 8)] ^= static_cast<std::byte>(1U << random.below(8));
    reseal(bytes);
    if (world.load(SnapshotKind::canonical, bytes) != Status::ok) continue;
    ++accepted;
    EXPECT_NE(world.hash().total, source.hash().total);
    expect_lives(world);
  }
  EXPECT_GT(accepted,
            k_rounds / 4);  // velocities, impulses, user data: most bits make another good world
}

}  // namespace
}  // namespace lockstone
