// Canonical snapshots as files.

#include <gtest/gtest.h>

#include <lockstone/hash.h>
#include <lockstone/replay/format.h>
#include <lockstone/replay/snapshot_file.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

Bytes canonical() {
  ToySimulation game(ToyConfig{});
  Bytes bytes(game.snapshot_bytes_max(SnapshotKind::canonical));
  bytes.resize(game.save(SnapshotKind::canonical, bytes));
  return bytes;
}

void reseal(Bytes& file) {
  const std::span<std::byte> all(file);
  ByteWriter(all.last(8)).put(hash64(all.first(all.size() - 8)));
}

TEST(SnapshotFile, ReturnsItsSnapshot) {
  for (const Bytes& bytes : {canonical(), Bytes{}, Bytes(1U << 20)}) {
    const Bytes file = pack_snapshot(bytes);
    const auto back = unpack_snapshot(file);
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(back.value(), bytes);
  }
  EXPECT_EQ(unpack_snapshot(Bytes(100)).status(), Status::malformed);
  if (compression_available()) {
    EXPECT_LT(pack_snapshot(canonical()).size(), canonical().size());
  }
}

TEST(SnapshotFile, RefusesEveryFlippedBitAndEveryTruncation) {
  const Bytes file = pack_snapshot(canonical());
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
    Bytes damaged = file;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    ASSERT_FALSE(unpack_snapshot(damaged).ok()) << bit;
  }
  for (std::size_t size = 0; size < file.size(); ++size)
    ASSERT_EQ(unpack_snapshot(ByteView(file).first(size)).status(), Status::truncated) << size;
}

TEST(SnapshotFile, RefusesToAllocateMoreThanTheCap) {
  Bytes file = pack_snapshot(canonical());
  ByteWriter(std::span(file).subspan(8)).put(static_cast<std::uint32_t>(k_max_keyframe_bytes + 1));
  reseal(file);
  EXPECT_EQ(unpack_snapshot(file).status(), Status::malformed);
  ByteWriter(std::span(file).subspan(8)).put(static_cast<std::uint32_t>(k_max_keyframe_bytes));
  reseal(file);
  EXPECT_FALSE(unpack_snapshot(file).ok());
}

}  // namespace
}  // namespace lockstone::test
