#include "net/session/command_buffer.h"

#include <deque>

#include <gtest/gtest.h>

#include "net/transport/random.h"

namespace lockstone::net {
namespace {

std::vector<std::byte> filled(std::size_t size, std::uint64_t seed) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::byte>(seed * 31 + i);
  return bytes;
}

TEST(CommandBuffer, IsAQueueInARing) {
  struct Kept {
    std::uint64_t tick;
    std::vector<std::byte> bytes;
  };
  Random random(3);
  CommandBuffer buffer(1000, 16);
  std::deque<Kept> queue;
  std::uint64_t tick = 0;
  std::size_t pushed = 0;
  for (int round = 0; round < 20'000; ++round) {
    if (random.below(5) < 3) {
      const std::vector<std::byte> bytes = filled(1 + random.below(300), random.below(250));
      tick += random.below(3);
      if (!buffer.push(tick, {1, bytes})) continue;
      queue.push_back({tick, bytes});
      ++pushed;
    } else if (!queue.empty()) {
      buffer.pop();
      queue.pop_front();
    }
    ASSERT_EQ(buffer.end() - buffer.begin(), queue.size());
    ASSERT_EQ(buffer.end(), pushed);
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint64_t number = buffer.begin() + i;
      ASSERT_EQ(buffer.entry(number).tick, queue[i].tick);
      ASSERT_TRUE(std::ranges::equal(buffer.bytes(number), queue[i].bytes)) << "round " << round;
    }
  }
  EXPECT_GT(pushed, 5000U);
}

TEST(CommandBuffer, HoldsACommandOfItsWholeSize) {
  CommandBuffer buffer(64, 4);
  EXPECT_TRUE(buffer.push(0, {0, filled(64, 1)}));
  EXPECT_FALSE(buffer.push(0, {0, filled(1, 1)}));
  buffer.pop();
  EXPECT_FALSE(buffer.push(0, {0, filled(65, 1)}));
  EXPECT_TRUE(buffer.push(0, {0, filled(64, 1)}));
}

TEST(CommandBuffer, ForgetsACommandThatNeverCameWhole) {
  CommandBuffer buffer(64, 4);
  ASSERT_TRUE(buffer.push(0, {0, filled(8, 1)}));
  ASSERT_TRUE(buffer.open(0, 0, 20));
  buffer.append(filled(5, 2));
  buffer.drop_incomplete();
  EXPECT_EQ(buffer.end(), 1U);
  buffer.drop_incomplete();
  EXPECT_EQ(buffer.end(), 1U);
}

TEST(TickCommands, GivesThoseOfOneTickThatAreWhole) {
  TickCommands commands;
  ASSERT_TRUE(commands.ring().push(4, {0, filled(3, 1)}));
  ASSERT_TRUE(commands.ring().push(5, {1, filled(4, 2)}));
  ASSERT_TRUE(commands.ring().push(5, {k_server_slot, filled(5, 3)}));
  ASSERT_TRUE(commands.ring().open(6, 0, 2));
  EXPECT_EQ(commands.of(3).size(), 0U);
  EXPECT_EQ(commands.of(5).size(), 2U);
  EXPECT_EQ(commands.of(5)[1].slot, k_server_slot);
  EXPECT_TRUE(commands.has(5, 2));
  EXPECT_FALSE(commands.has(6, 1));
  EXPECT_TRUE(commands.has(7, 0));
  commands.forget_before(5);
  EXPECT_EQ(commands.of(4).size(), 0U);
  EXPECT_EQ(commands.of(5).size(), 2U);
}

}  // namespace
}  // namespace lockstone::net
