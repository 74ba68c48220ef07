#include "replay/codec/input_codec.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/replay/format.h>

#include "replay/codec/header_codec.h"
#include "tests/support/random.h"

namespace lockstone::replay {
namespace {

struct Shape {
  std::size_t players;
  std::size_t input_bytes;
  std::size_t ticks;
};

// Inputs of consecutive ticks, held by value.
using Ticks = std::vector<std::vector<SlotState>>;

std::vector<std::byte> encode(const Ticks& ticks, const Shape& shape) {
  std::vector<std::byte> out(
      InputEncoder::bytes_max(shape.ticks, shape.players, shape.input_bytes));
  InputEncoder encoder;
  encoder.start(out, shape.input_bytes);
  for (const auto& slots : ticks) {
    std::vector<PlayerInput> inputs;
    for (const SlotState& slot : slots) {
      inputs.push_back({ByteView(slot.bytes).first(shape.input_bytes), slot.origin});
    }
    encoder.add(inputs);
  }
  out.resize(encoder.finish());
  return out;
}

void expect_equal(const Ticks& ticks, const InputBlock& block, const Shape& shape) {
  ASSERT_EQ(block.ticks(), ticks.size());
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    for (std::size_t slot = 0; slot < shape.players; ++slot) {
      const PlayerInput& input = block.tick(i)[slot];
      EXPECT_EQ(input.origin, ticks[i][slot].origin);
      ASSERT_EQ(input.bytes.size(), shape.input_bytes);
      EXPECT_TRUE(std::equal(input.bytes.begin(), input.bytes.end(), ticks[i][slot].bytes.begin()));
    }
  }
}

Ticks random_ticks(std::mt19937_64& random, const Shape& shape) {
  Ticks ticks;
  std::vector<SlotState> slots(shape.players);
  // From "changes all the time" to "hardly ever".
  const std::uint64_t calm = 1 + random() % 200;
  for (std::size_t i = 0; i < shape.ticks; ++i) {
    for (SlotState& slot : slots) {
      if (random() % calm == 0) slot.origin = static_cast<InputOrigin>(random() % 4);
      for (std::size_t k = 0; k < shape.input_bytes; ++k) {
        if (random() % calm == 0) slot.bytes[k] = static_cast<std::byte>(random() & 0xff);
      }
    }
    ticks.push_back(slots);
  }
  return ticks;
}

TEST(InputCodec, GivesBackRandomInputsOfEveryShape) {
  std::mt19937_64 random(test::run_seed());
  for (int round = 0; round < 200; ++round) {
    const Shape shape{1 + random() % k_max_players, 1 + random() % k_max_input_bytes,
                      1 + random() % 300};
    const Ticks ticks = random_ticks(random, shape);
    const auto bytes = encode(ticks, shape);
    InputBlock block;
    ASSERT_TRUE(block.decode(bytes, shape.ticks, shape.players, shape.input_bytes).ok());
    expect_equal(ticks, block, shape);
  }
}

TEST(InputCodec, KeepsAllTicksOfRunsAroundTheFullRun) {
  for (std::size_t run = 250; run <= 260; ++run) {
    const Shape shape{3, 4, 2 * run + 1};
    Ticks ticks(shape.ticks, std::vector<SlotState>(shape.players));
    ticks[run][1].bytes[2] = std::byte{9};
    const auto bytes = encode(ticks, shape);
    InputBlock block;
    ASSERT_TRUE(block.decode(bytes, shape.ticks, shape.players, shape.input_bytes).ok());
    expect_equal(ticks, block, shape);
  }
}

TEST(InputCodec, SilenceTakesOneByteForTwoHundredTicks) {
  const Shape shape{16, 64, 200};
  EXPECT_EQ(encode(Ticks(200, std::vector<SlotState>(16)), shape).size(), 1U);
}

TEST(InputCodec, LongestPayloadIsWithinTheFormatsLimit) {
  EXPECT_LE(InputEncoder::bytes_max(k_max_chunk_ticks, k_max_players, k_max_input_bytes),
            max_payload_bytes(ChunkType::input));
}

TEST(InputCodec, WorstCaseFitsItsBound) {
  const Shape shape{16, 64, 60};
  Ticks ticks;
  for (std::size_t i = 0; i < shape.ticks; ++i) {
    SlotState slot;
    slot.bytes.fill(static_cast<std::byte>(i + 1));
    ticks.emplace_back(shape.players, slot);
  }
  EXPECT_EQ(encode(ticks, shape).size(), InputEncoder::bytes_max(60, 16, 64));
  EXPECT_LE(encode(ticks, shape).size(), max_payload_bytes(ChunkType::input));
}

// Whatever decodes, encodes to the same bytes again: one content, one encoding.
TEST(InputCodec, AcceptsRandomBytesOnlyInCanonicalForm) {
  std::mt19937_64 random(test::run_seed());
  std::size_t accepted = 0;
  for (int round = 0; round < 200'000; ++round) {
    const Shape shape{1 + random() % 3, 1 + random() % 2, 1 + random() % 4};
    std::vector<std::byte> bytes(1 + random() % 10);
    for (std::byte& byte : bytes)
      byte = static_cast<std::byte>(random() % 8);
    InputBlock block;
    if (!block.decode(bytes, shape.ticks, shape.players, shape.input_bytes).ok()) continue;
    ++accepted;
    Ticks ticks;
    for (std::size_t i = 0; i < block.ticks(); ++i) {
      auto& slots = ticks.emplace_back(shape.players);
      for (std::size_t slot = 0; slot < shape.players; ++slot) {
        const PlayerInput& input = block.tick(i)[slot];
        slots[slot].origin = input.origin;
        std::copy(input.bytes.begin(), input.bytes.end(), slots[slot].bytes.begin());
      }
    }
    ASSERT_EQ(encode(ticks, shape), bytes);
  }
  EXPECT_GT(accepted, 100U);
}

}  // namespace
}  // namespace lockstone::replay
