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
  LKS_CHECK(recorder.begin(info, config,
                           {.match_id = 0x4142434445464748,
                            .seed = 0x5152535455565758,
                            .build = "b1",
                            .game = "g",
                            .game_version = "v2"}) == Status::ok);
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

TEST(Golden, TheFirstBytesOfALogAreTheFormatsFourthVersion) {
  const Bytes log = tiny_log();
  constexpr std::string_view k_expected =
      // file header
      "894c4b530d0a1a0a04005b0004030201181716151413121128272625242322213837363534333231"
      "3c0002030000000048474645444342415857565554535251000000000000000002006231010067"
      "020076326a59464a7b8b4e33"
      // frame of SCENE
      "a74c4b43010100000000000000000000000000000000000002000000020000006a59464a7b8b4e33"
      "23552efe7529935e3d836c899facd612"
      // its payload
      "c0c1"
      // frame of INPUT
      "a74c4b4302010000010000000500000000000000000000000b0000000b0000003d836c899facd612"
      "11ddfc6472db6f80658a14d0dcb05b86"
      // its payload
      "0203040277040277010201"
      // the beginning of HASH
      "a74c4b4303010000020000000500000000000000000000002800000028000000658a14d0dcb05b86";
  EXPECT_EQ(hexadecimal(std::span(log).first(256)), k_expected);
}

TEST(Golden, AWholeTinyLogIsTheFormatsFourthVersion) {
  const Bytes log = tiny_log();
  EXPECT_EQ(log.size(), 581U);
  EXPECT_EQ(hash64(log), 436146575339630143U);
}

}  // namespace
}  // namespace lockstone::test
