#include "replay/chunks/log_order.h"

#include <gtest/gtest.h>

#include "replay/chunks/chunk_chain.h"

namespace lockstone::replay {
namespace {

ChunkHeader chunk_of(ChunkType type, std::uint64_t first_tick, std::uint32_t count = 0) {
  ChunkHeader chunk;
  chunk.type = type;
  chunk.first_tick = first_tick;
  chunk.count = count;
  return chunk;
}

LogOrder with_scene() {
  LogOrder order;
  order.begin(0);
  order.note_scene();
  return order;
}

TEST(LogOrder, WantsASceneFirstAndOnce) {
  LogOrder order;
  order.begin(0);
  EXPECT_NE(order.check(chunk_of(ChunkType::input, 0, 4)), nullptr);
  EXPECT_EQ(order.check(chunk_of(ChunkType::scene, 0)), nullptr);
  order.note_scene();
  EXPECT_NE(order.check(chunk_of(ChunkType::scene, 0)), nullptr);
}

TEST(LogOrder, WantsHashesRightAfterTheirInputs) {
  LogOrder order = with_scene();
  EXPECT_NE(order.check(chunk_of(ChunkType::hash, 0, 4)), nullptr);
  order.note_inputs(4);
  EXPECT_NE(order.check(chunk_of(ChunkType::input, 4, 4)), nullptr);
  EXPECT_EQ(order.check(chunk_of(ChunkType::hash, 0, 4)), nullptr);
  EXPECT_NE(order.check(chunk_of(ChunkType::hash, 4, 4)), nullptr);
  order.note_hashes(7);
  EXPECT_EQ(order.check(chunk_of(ChunkType::input, 4, 4)), nullptr);
  EXPECT_NE(order.check(chunk_of(ChunkType::input, 5, 4)), nullptr) << "tick 4 would lack";
}

TEST(LogOrder, WantsInputsRightAfterTheirCommands) {
  LogOrder order = with_scene();
  EXPECT_EQ(order.check(chunk_of(ChunkType::command, 0, 1)), nullptr);
  EXPECT_NE(order.check(chunk_of(ChunkType::command, 1, 1)), nullptr);
  order.note_commands();
  EXPECT_NE(order.check(chunk_of(ChunkType::command, 0, 1)), nullptr);
  EXPECT_NE(order.check(chunk_of(ChunkType::keyframe, 0)), nullptr);
  EXPECT_EQ(order.check(chunk_of(ChunkType::input, 0, 4)), nullptr);
  order.note_inputs(4);
  EXPECT_NE(order.check(chunk_of(ChunkType::command, 4, 1)), nullptr);
  order.note_hashes(7);
  EXPECT_EQ(order.check(chunk_of(ChunkType::command, 4, 1)), nullptr);
}

TEST(LogOrder, WantsOneKeyframeATickWithTheHashOfTheTickBefore) {
  LogOrder order = with_scene();
  order.note_inputs(4);
  order.note_hashes(7);
  EXPECT_NE(order.check_keyframe(8), nullptr);
  EXPECT_EQ(order.check_keyframe(7), nullptr);
  EXPECT_EQ(order.check(chunk_of(ChunkType::keyframe, 4)), nullptr);
  order.note_keyframe(4, 7);
  EXPECT_NE(order.check(chunk_of(ChunkType::keyframe, 4)), nullptr);
}

TEST(LogOrder, WantsAKeyframeWhereALogBeginsLate) {
  LogOrder order;
  order.begin(100);
  order.note_scene();
  EXPECT_NE(order.check_start(), nullptr);
  order.note_keyframe(100, 5);
  EXPECT_EQ(order.check_start(), nullptr);
}

TEST(LogOrder, ComparesTheTotalsOfTheEnd) {
  LogOrder order = with_scene();
  order.note_inputs(4);
  order.note_hashes(7);
  LogEnd end;
  end.final_tick = 4;
  end.final_hash = 7;
  end.ticks = 4;
  end.transcript = order.transcript();
  EXPECT_EQ(order.check_end(end), nullptr);
  end.ticks = 5;
  EXPECT_NE(order.check_end(end), nullptr);
  order.jump(4);
  order.note_keyframe(4, 7);
  EXPECT_EQ(order.check_end(end), nullptr) << "totals do not count after a jump";
}

TEST(LogOrder, TakesOneSignatureBehindTheEnd) {
  LogOrder order = with_scene();
  order.note_end();
  EXPECT_TRUE(order.take_signature());
  EXPECT_FALSE(order.take_signature());
}

ChunkFrame frame_of(std::uint32_t sequence, std::uint64_t previous, std::uint64_t checksum) {
  ChunkFrame frame;
  frame.header.sequence = sequence;
  frame.header.stored_bytes = 10;
  frame.previous = previous;
  frame.checksum = checksum;
  return frame;
}

TEST(ChunkChain, FollowsNumbersAndChecksums) {
  ChunkChain chain;
  chain.begin(64, 11);
  EXPECT_FALSE(chain.check(frame_of(0, 11, 12), "first"));
  chain.advance(frame_of(0, 11, 12));
  EXPECT_EQ(chain.next_offset(), 64 + k_chunk_header_bytes + 10);
  EXPECT_EQ(chain.check(frame_of(2, 12, 13), "third")->status, Status::malformed);
  EXPECT_EQ(chain.check(frame_of(1, 99, 13), "second")->status, Status::checksum_mismatch);
  EXPECT_FALSE(chain.check(frame_of(1, 12, 13), "second"));
}

TEST(ChunkChain, TakesTheFirstChunkAfterAJumpAsItIs) {
  ChunkChain chain;
  chain.begin(64, 11);
  chain.jump(500);
  EXPECT_FALSE(chain.check(frame_of(9, 77, 78), "any"));
  chain.advance(frame_of(9, 77, 78));
  EXPECT_TRUE(chain.check(frame_of(11, 78, 79), "not the next one"));
}

}  // namespace
}  // namespace lockstone::replay
