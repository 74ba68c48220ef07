// Pins the format: a change of these bytes is a change of the format version.
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include <lockstone/hash.h>
#include <lockstone/replay/recorder.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

// Made from literals only, so that no change of a game can change it.
Bytes tiny_log() {
  SimulationInfo info;
  info.abi = 0x01020304;
  info.config_hash = 0x1112131415161718;
  info.scene_hash = 0x2122232425262728;
  info.canary = 0x3132333435363738;
  info.tick_rate = 60;
  info.player_count = 2;
  info.input_bytes = 3;
  const std::array<std::byte, 2> config{std::byte{0xc0}, std::byte{0xc1}};
  MemorySink sink;
  Recorder recorder(sink, {.keyframe_bytes_max = 16, .compress = false, .index = false});
  LKS_CHECK(
      recorder.begin(info, config,
                     {.match_id = 0x4142434445464748, .seed = 0x5152535455565758, .build = "b1"}) ==
      Status::ok);
  std::array<std::byte, 3> bytes{};
  for (std::uint64_t tick = 0; tick < 5; ++tick) {
    if (tick == 2) bytes[1] = std::byte{0x77};
    const PlayerInput late{bytes, tick == 4 ? InputOrigin::repeated : InputOrigin::received};
    const std::array<PlayerInput, 2> inputs{PlayerInput{bytes}, late};
    LKS_CHECK(recorder.record_tick(tick, inputs, 0xa0 + tick) == Status::ok);
  }
  LKS_CHECK(recorder.event(4, EventKind::substitution, 1, "late") == Status::ok);
  LKS_CHECK(recorder.keyframe(5, 0xa4, config) == Status::ok);
  LKS_CHECK(recorder.finish("done") == Status::ok);
  return sink.bytes();
}

std::string hexadecimal(ByteView bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte) >> 4];
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

TEST(Golden, TheFirstBytesOfALogAreTheFormatsSecondVersion) {
  const Bytes log = tiny_log();
  constexpr std::string_view k_expected =
      // file header
      "894c4b530d0a1a0a0200540004030201181716151413121128272625242322213837363534333231"
      "3c00020300000000484746454443424158575655545352510000000000000000020062317c6f4576"
      "017a6498"
      // frame of SCENE
      "a74c4b43010100000000000000000000000000000000000002000000020000007c6f4576017a6498"
      "23552efe7529935e77007dfcb6db2a47"
      // its payload
      "c0c1"
      // frame of INPUT
      "a74c4b4302010000010000000500000000000000000000000b0000000b00000077007dfcb6db2a47"
      "11ddfc6472db6f80b8909d9850d8bb20"
      // its payload
      "0203040277040277010201"
      // the beginning of HASH
      "a74c4b4303010000020000000500000000000000000000002800000028000000b8909d9850d8bb20"
      "9cbe8d";
  EXPECT_EQ(hexadecimal(std::span(log).first(252)), k_expected);
}

TEST(Golden, AWholeTinyLogIsTheFormatsSecondVersion) {
  const Bytes log = tiny_log();
  EXPECT_EQ(log.size(), 574U);
  EXPECT_EQ(hash64(log), 12319566902514708940U);
}

}  // namespace
}  // namespace lockstone::test
