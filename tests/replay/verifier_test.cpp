#include <gtest/gtest.h>

#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/verifier.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

// A toy that claims to be something else, from a factory.
SimulationFactory impostor(const std::function<void(SimulationInfo&)>& alter) {
  return [alter](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const auto config = ToyConfig::decode(bytes);
    if (!config) return config.status();
    auto toy = std::make_unique<ToySimulation>(config.value());
    SimulationInfo info = toy->info();
    alter(info);
    toy->override_info(info);
    return std::unique_ptr<Simulation>(std::move(toy));
  };
}

// A toy whose snapshots forget a field: the negative control of keyframe checks.
class Forgetful final : public Simulation {
 public:
  explicit Forgetful(const ToyConfig& config) : toy_(config) {}

  SimulationInfo info() const override { return toy_.info(); }
  std::uint64_t tick() const override { return toy_.tick(); }
  void step(std::span<const PlayerInput> inputs) override { toy_.step(inputs); }
  std::size_t snapshot_bytes_max(SnapshotKind kind) const override {
    return toy_.snapshot_bytes_max(kind);
  }
  std::size_t save(SnapshotKind kind, std::span<std::byte> out) const override {
    const std::size_t bytes = toy_.save(kind, out);
    std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(bytes - 8), 8, std::byte{0});
    return bytes;
  }
  Status load(SnapshotKind kind, ByteView bytes) override { return toy_.load(kind, bytes); }
  std::uint64_t hash() const override { return toy_.hash(); }
  StateDifference describe(ByteView here, ByteView there) const override {
    return toy_.describe(here, there);
  }

 private:
  ToySimulation toy_;
};

TEST(Verify, AWholeLogIsTheSame) {
  const Bytes log = record({.ticks = 700, .keyframe_interval = 600, .chunk_ticks = 0});
  const VerifyReport report = verify_toy(log, {.strict = true});
  EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
  EXPECT_EQ(exit_code(report.outcome), 0);
  EXPECT_EQ(report.ticks_verified, 700U);
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.end_reason, "match over");
  EXPECT_EQ(report.to_line(), "same; 700 ticks verified");
}

TEST(Verify, ALogThatStartsLaterBeginsFromItsKeyframe) {
  const Bytes log = record({.ticks = 40, .start_tick = 100});
  const VerifyReport report = verify_toy(log, {.strict = true});
  EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
  EXPECT_EQ(report.start_tick, 100U);
  EXPECT_EQ(report.ticks_verified, 40U);
}

TEST(Verify, ReportsProgressUpToTheTotal) {
  const Bytes log = record({.ticks = 50});
  MemorySource source(log);
  std::uint64_t last = 0;
  const VerifyReport report =
      verify(source, toy_factory(), {}, [&](std::uint64_t ticks, std::uint64_t total) {
        EXPECT_GT(ticks, last);
        EXPECT_EQ(total, 50U);
        last = ticks;
      });
  EXPECT_EQ(report.outcome, VerifyOutcome::same);
  EXPECT_EQ(last, 50U);
}

TEST(Verify, TruncatedAtEveryLengthIsTheSameUpToItsLastWholeHashes) {
  const Bytes log = record({.ticks = 12});
  const auto chunks = chunks_of(log);
  for (std::size_t length = chunks[0].offset; length < log.size(); ++length) {
    const Bytes cut(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(length));
    std::uint64_t ticks = 0;
    bool at_boundary = length == chunks[0].offset;
    for (const ChunkPlace& place : chunks) {
      at_boundary = at_boundary || place.end() == length;
      const bool whole = place.end() <= length;
      if (whole && place.frame.header.type == ChunkType::hash) ticks += place.frame.header.count;
    }
    const VerifyReport report = verify_toy(cut);
    EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
    EXPECT_EQ(report.ticks_verified, ticks);
    EXPECT_EQ(report.torn_tail, !at_boundary);
    EXPECT_EQ(report.damage.has_value(), !at_boundary);
    EXPECT_FALSE(report.complete);
    EXPECT_EQ(verify_toy(cut, {.strict = true}).outcome, VerifyOutcome::corrupt);
  }
}

TEST(Verify, AlteredInputsDivergeAtExactlyTheirTick) {
  const Bytes log = record({.ticks = 30});
  for (std::uint64_t altered = 0; altered < 30; ++altered) {
    const Bytes forged = rewrite(log, [&](std::uint64_t tick, std::size_t slot, auto bytes) {
      if (tick == altered && slot == 1) bytes[0] ^= std::byte{1};
    });
    const VerifyReport report = verify_toy(forged);
    ASSERT_EQ(report.outcome, VerifyOutcome::diverged) << report.to_line();
    EXPECT_EQ(exit_code(report.outcome), 1);
    EXPECT_EQ(report.divergence->tick, altered);
    EXPECT_EQ(report.ticks_verified, altered);
    EXPECT_NE(report.divergence->expected, report.divergence->actual);
    EXPECT_TRUE(report.complete) << "the rest is still read";
  }
}

TEST(Verify, AStateBitFlippedWhileRecordingDivergesAtExactlyItsTick) {
  for (std::uint64_t flipped = 0; flipped < 30; ++flipped) {
    const VerifyReport report = verify_toy(record({.ticks = 30, .flip_at = flipped}));
    ASSERT_EQ(report.outcome, VerifyOutcome::diverged) << report.to_line();
    EXPECT_EQ(report.divergence->tick, flipped);
    EXPECT_EQ(report.ticks_verified, flipped);
  }
}

TEST(Verify, NamesTheFirstDifferenceAtTheNextKeyframe) {
  // A keyframe at tick 16 stands right after tick 15.
  const VerifyReport report = verify_toy(record({.ticks = 30, .flip_at = 15}));
  ASSERT_TRUE(report.divergence.has_value());
  ASSERT_TRUE(report.divergence->difference.has_value());
  EXPECT_EQ(report.divergence->difference_tick, 16U);
  EXPECT_EQ(report.divergence->difference->store, "body");
  EXPECT_EQ(report.divergence->difference->object, 1U);
  EXPECT_EQ(report.divergence->difference->field, "position.x");
  EXPECT_NE(report.to_line().find("tick 15: hash 0x"), std::string::npos) << report.to_line();
  EXPECT_NE(report.to_line().find("at tick 16 body 1 \"barrel\", position.x"), std::string::npos)
      << report.to_line();
}

TEST(Verify, GoesOnToALaterKeyframeToExplain) {
  const VerifyReport report = verify_toy(record({.ticks = 30, .flip_at = 9}));
  ASSERT_TRUE(report.divergence->difference.has_value());
  EXPECT_EQ(report.divergence->tick, 9U);
  EXPECT_EQ(report.divergence->difference_tick, 16U);
  const VerifyReport brief = verify_toy(record({.ticks = 30, .flip_at = 9}), {.explain = false});
  EXPECT_EQ(brief.divergence->tick, 9U);
  EXPECT_FALSE(brief.divergence->difference.has_value());
}

TEST(Verify, WithoutALaterKeyframeThereIsNoExplanation) {
  const VerifyReport report = verify_toy(record({.ticks = 30, .flip_at = 29}));
  EXPECT_EQ(report.divergence->tick, 29U);
  EXPECT_FALSE(report.divergence->difference.has_value());
}

TEST(Verify, DamageAfterADivergenceIsReportedWithIt) {
  Bytes log = record({.ticks = 30, .flip_at = 3});
  log.back() ^= std::byte{1};
  const VerifyReport report = verify_toy(log);
  EXPECT_EQ(report.outcome, VerifyOutcome::diverged);
  EXPECT_EQ(report.divergence->tick, 3U);
  EXPECT_EQ(report.damage->type, ChunkType::end);
  EXPECT_FALSE(report.complete);
}

TEST(Verify, EveryFieldOfAnotherSimulationIsNamedWithBothValues) {
  const Bytes log = record({});
  const auto mismatch = [&](const std::function<void(SimulationInfo&)>& alter) {
    MemorySource source(log);
    const VerifyReport report = verify(source, impostor(alter));
    EXPECT_EQ(report.outcome, VerifyOutcome::incompatible);
    EXPECT_EQ(exit_code(report.outcome), 3);
    EXPECT_EQ(report.ticks_verified, 0U);
    EXPECT_EQ(report.mismatches.size(), 1U);
    EXPECT_NE(report.mismatches[0].log, report.mismatches[0].here);
    return report.mismatches[0].field;
  };
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.abi; }), "abi");
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.config_hash; }), "config hash");
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.scene_hash; }), "scene hash");
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.canary; }), "canary");
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.tick_rate; }), "tick rate");
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.player_count; }), "player count");
  EXPECT_EQ(mismatch([](SimulationInfo& info) { ++info.input_bytes; }), "input bytes");
  MemorySource source(log);
  const VerifyReport report =
      verify(source, impostor([](SimulationInfo& info) { info.tick_rate = 30; }));
  EXPECT_EQ(report.to_line(), "incompatible: tick rate 60 in the log, 30 here; 0 ticks verified");
}

TEST(Verify, AConfigurationThatTheGameRefusesIsIncompatible) {
  const Bytes log = record({});
  MemorySource source(log);
  const VerifyReport report = verify(source, [](ByteView) -> Result<std::unique_ptr<Simulation>> {
    return Status::unsupported_version;
  });
  EXPECT_EQ(report.outcome, VerifyOutcome::incompatible);
  EXPECT_EQ(report.damage->status, Status::unsupported_version);
  EXPECT_EQ(report.damage->type, ChunkType::scene);
}

TEST(Verify, ASnapshotThatForgetsAFieldIsCaughtAtItsKeyframe) {
  const ToyConfig config{.body_count = 3};
  const auto factory = [](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const auto decoded = ToyConfig::decode(bytes);
    if (!decoded) return decoded.status();
    return std::unique_ptr<Simulation>(std::make_unique<Forgetful>(decoded.value()));
  };
  Forgetful game(config);
  MemorySink sink;
  Recorder recorder(sink, {.keyframe_interval_ticks = 20, .keyframe_bytes_max = 4096});
  ASSERT_EQ(recorder.begin(game.info(), config.encode(), {}), Status::ok);
  Bytes bytes(8);
  for (std::uint64_t tick = 0; tick < 50; ++tick) {
    // Button 0 pressed, the last body as the target: its heat, the forgotten field, becomes hot.
    const std::array<std::byte, 4> press{{std::byte{}, std::byte{}, std::byte{1}, std::byte{2}}};
    const std::array<PlayerInput, 2> inputs{PlayerInput{press}, PlayerInput{press}};
    game.step(inputs);
    ASSERT_EQ(recorder.record_step(game, inputs), Status::ok);
  }
  ASSERT_EQ(recorder.finish(""), Status::ok);
  MemorySource source(sink.bytes());
  const VerifyReport report = verify(source, factory);
  ASSERT_EQ(report.outcome, VerifyOutcome::diverged);
  EXPECT_TRUE(report.divergence->in_keyframe);
  EXPECT_EQ(report.divergence->tick, 20U);
  EXPECT_EQ(report.ticks_verified, 20U);
}

TEST(Verify, KeyframesLoadAndStepOnToTheSameHashes) {
  const Bytes log = record({.ticks = 60});
  MemorySource source(log);
  LogReader reader(source);
  ASSERT_EQ(reader.open(), Status::ok);
  ToySimulation game(ToyMatch{}.config);
  std::size_t loads = 0;
  for (LogItem item = reader.next(); !is_last(item); item = reader.next()) {
    if (item == LogItem::keyframe) {
      ToySimulation loaded(ToyMatch{}.config);
      ASSERT_EQ(loaded.load(SnapshotKind::canonical, reader.snapshot()), Status::ok);
      EXPECT_EQ(loaded.hash(), reader.keyframe_hash());
      game = loaded;
      ++loads;
    }
    if (item != LogItem::hashes) continue;
    for (std::size_t i = 0; i < reader.hashes().size(); ++i) {
      game.step(reader.tick_inputs(i));
      EXPECT_EQ(game.hash(), reader.hashes()[i]);
    }
  }
  EXPECT_EQ(loads, 7U);
}

TEST(Verify, AKeyframeThatDoesNotLoadIsIncompatible) {
  Bytes log = record({.ticks = 20});
  const auto chunks = chunks_of(log);
  const ChunkPlace& place = chunks[find_chunk(chunks, ChunkType::keyframe)];
  log[place.offset + k_chunk_header_bytes + 8] ^= std::byte{1};  // the toy's own magic
  relink(log);
  const VerifyReport report = verify_toy(log);
  EXPECT_EQ(report.outcome, VerifyOutcome::incompatible);
  EXPECT_EQ(report.damage->offset, place.offset);
  EXPECT_EQ(report.ticks_verified, 8U);
}

}  // namespace
}  // namespace lockstone::test
