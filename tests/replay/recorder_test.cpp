#include <gtest/gtest.h>

#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/recorder.h>

#include "tests/replay/allocation_count.h"
#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

// Takes this many bytes and then behaves like a full disk: the last write is cut short.
class FullDisk final : public Sink {
 public:
  explicit FullDisk(std::size_t capacity) : capacity_(capacity) {}

  Status append(ByteView bytes) override {
    const std::size_t room = capacity_ - bytes_.size();
    const ByteView taken = bytes.first(std::min(room, bytes.size()));
    bytes_.insert(bytes_.end(), taken.begin(), taken.end());
    if (taken.size() < bytes.size()) ++refusals;
    return taken.size() == bytes.size() ? Status::ok : Status::io_error;
  }

  [[nodiscard]] const Bytes& bytes() const { return bytes_; }

  int refusals = 0;

 private:
  std::size_t capacity_;
  Bytes bytes_;
};

struct Fixture {
  ToyConfig config{.body_count = 4};
  ToySimulation game{config};
  ToyInputs inputs{config};
  MemorySink sink;
  Recorder recorder{sink, {.keyframe_interval_ticks = 10, .keyframe_bytes_max = 1U << 16}};

  Status begin(std::uint64_t start_tick = 0) {
    return recorder.begin(game.info(), config.encode(), {.start_tick = start_tick, .build = "t"});
  }

  Status play() {
    const std::uint64_t tick = game.tick();
    game.step(inputs.at(tick));
    return recorder.record_step(game, inputs.at(tick));
  }
};

/// A recorded match, and a reader at its beginning.
class RecordedMatch : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(reader_.open(), Status::ok); }

  /// Calls `visit` for each item of the log.
  template <class Visit>
  void read_all(const Visit& visit) {
    for (LogItem item = reader_.next(); item != LogItem::finished; item = reader_.next()) {
      ASSERT_FALSE(is_last(item)) << reader_.damage().what;
      visit(item);
    }
  }

  /// Steps a game of its own by each tick that was read.
  void step_game() {
    for (std::size_t i = 0; i < reader_.hashes().size(); ++i)
      game_.step(inputs_.at(game_.tick()));
  }

  const ToyMatch match_ = [] {
    ToyMatch match{.ticks = 130};
    match.config.player_count = 4;
    match.config.input_bytes = 11;
    return match;
  }();
  const Bytes log_ = record(match_);
  MemorySource source_{log_};
  LogReader reader_{source_};
  ToySimulation game_{match_.config};
  ToyInputs inputs_{match_.config};
};

TEST_F(RecordedMatch, HasItsHeader) {
  EXPECT_EQ(reader_.header().match.match_id, 7U);
  EXPECT_EQ(reader_.header().match.build, "toy 1");
  EXPECT_EQ(reader_.header().info, game_.info());
}

TEST_F(RecordedMatch, HasItsConfiguration) {
  read_all([&](LogItem item) {
    if (item != LogItem::scene) return;
    EXPECT_EQ(Bytes(reader_.config().begin(), reader_.config().end()), match_.config.encode());
  });
}

TEST_F(RecordedMatch, HasTheInputsOfEachTick) {
  read_all([&](LogItem item) {
    if (item != LogItem::hashes) return;
    for (std::size_t i = 0; i < reader_.hashes().size(); ++i) {
      const auto expected = inputs_.at(game_.tick() + i);
      const auto actual = reader_.tick_inputs(i);
      ASSERT_EQ(actual.size(), expected.size());
      for (std::size_t slot = 0; slot < actual.size(); ++slot) {
        EXPECT_EQ(actual[slot].origin, expected[slot].origin);
        EXPECT_TRUE(std::ranges::equal(actual[slot].bytes, expected[slot].bytes));
      }
    }
    step_game();
  });
  EXPECT_EQ(game_.tick(), 130U);
}

TEST_F(RecordedMatch, HasTheHashOfEachTick) {
  read_all([&](LogItem item) {
    if (item != LogItem::hashes) return;
    for (const std::uint64_t hash : reader_.hashes()) {
      game_.step(inputs_.at(game_.tick()));
      EXPECT_EQ(hash, game_.hash());
    }
  });
  EXPECT_EQ(game_.tick(), 130U);
}

TEST_F(RecordedMatch, HasTheStateAtEachKeyframe) {
  std::size_t keyframes = 0;
  read_all([&](LogItem item) {
    if (item == LogItem::hashes) step_game();
    if (item != LogItem::keyframe) return;
    ++keyframes;
    EXPECT_EQ(game_.tick(), reader_.chunk().first_tick);
    Bytes snapshot(game_.snapshot_bytes_max(SnapshotKind::canonical));
    snapshot.resize(game_.save(SnapshotKind::canonical, snapshot));
    EXPECT_EQ(Bytes(reader_.snapshot().begin(), reader_.snapshot().end()), snapshot);
  });
  EXPECT_EQ(keyframes, 130U / 8);
}

TEST_F(RecordedMatch, HasItsEvents) {
  std::size_t events = 0;
  read_all([&](LogItem item) {
    if (item == LogItem::events) events += reader_.events().size();
  });
  EXPECT_EQ(events, 15U);
}

TEST_F(RecordedMatch, HasItsEnd) {
  read_all([](LogItem) {});
  EXPECT_TRUE(reader_.complete());
  EXPECT_EQ(reader_.end().reason, "match over");
  EXPECT_EQ(reader_.end().final_tick, 130U);
}

TEST(Recorder, NeverAllocatesAfterBegin) {
  ToySimulation game(ToyConfig{});
  ToyInputs inputs(ToyConfig{});
  MemorySink sink(1U << 20);
  Recorder recorder(sink, {.keyframe_interval_ticks = 30,
                           .keyframe_bytes_max = game.snapshot_bytes_max(SnapshotKind::canonical)});
  ASSERT_EQ(recorder.begin(game.info(), ToyConfig{}.encode(), {}), Status::ok);
  take_heap_use();
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    game.step(inputs.at(tick));
    EXPECT_EQ(recorder.event(tick, EventKind::note, k_no_slot, "nothing special"), Status::ok);
    EXPECT_EQ(recorder.record_step(game, inputs.at(tick)), Status::ok);
  }
  EXPECT_EQ(recorder.finish("done"), Status::ok);
  EXPECT_EQ(take_heap_use().allocations, 0U);
}

TEST(Recorder, TakesKeyframesMoreOftenInTheFirstMinute) {
  ToySimulation game(ToyConfig{});
  ToyInputs inputs(ToyConfig{});
  MemorySink sink;
  Recorder recorder(sink, {.keyframe_bytes_max = game.snapshot_bytes_max(SnapshotKind::canonical)});
  ASSERT_EQ(recorder.begin(game.info(), ToyConfig{}.encode(), {}), Status::ok);
  for (std::uint64_t tick = 0; tick < k_early_ticks + 1500; ++tick) {
    game.step(inputs.at(tick));
    ASSERT_EQ(recorder.record_step(game, inputs.at(tick)), Status::ok);
  }
  ASSERT_EQ(recorder.finish("done"), Status::ok);
  MemorySource source(sink.bytes());
  std::vector<std::uint64_t> ticks;
  for (const KeyframePlace& place : map_log(source).keyframes)
    ticks.push_back(place.tick);
  ASSERT_EQ(ticks.size(), 3600U / 150 + 2);
  EXPECT_EQ(ticks.front(), 150U);
  EXPECT_EQ(ticks[23], 3600U);
  EXPECT_EQ(ticks[24], 4200U);
  EXPECT_EQ(ticks[25], 4800U);
}

TEST(Recorder, HandsOnInputsAndHashesAtLeastOnceASecond) {
  Fixture fixture;
  ASSERT_EQ(fixture.begin(), Status::ok);
  for (int i = 0; i < 60; ++i)
    ASSERT_EQ(fixture.play(), Status::ok);
  const VerifyReport report = verify_toy(fixture.sink.bytes());
  EXPECT_EQ(report.outcome, VerifyOutcome::same);
  EXPECT_EQ(report.ticks_verified, 60U);
  EXPECT_FALSE(report.complete);
  EXPECT_FALSE(report.torn_tail);
}

TEST(Recorder, DestroyedUnfinishedItWritesPendingTicksAndNoEnd) {
  MemorySink sink;
  const ToyMatch match{.ticks = 13, .finishes = false};
  ASSERT_EQ(record(match, sink), Status::ok);
  const VerifyReport report = verify_toy(sink.bytes());
  EXPECT_EQ(report.outcome, VerifyOutcome::same);
  EXPECT_EQ(report.ticks_verified, 13U);
  EXPECT_FALSE(report.complete);
}

TEST(Recorder, RefusesATickThatIsNotTheNext) {
  Fixture fixture;
  const auto inputs = fixture.inputs.at(0);
  EXPECT_EQ(fixture.recorder.record_tick(0, inputs, 1), Status::invalid_argument);
  ASSERT_EQ(fixture.begin(), Status::ok);
  EXPECT_EQ(fixture.begin(), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.record_tick(1, inputs, 1), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.record_tick(0, inputs.first(1), 1), Status::invalid_argument);
  const PlayerInput short_input{inputs[0].bytes.first(1)};
  const std::array<PlayerInput, 2> bad{short_input, short_input};
  EXPECT_EQ(fixture.recorder.record_tick(0, bad, 1), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.record_tick(0, inputs, 1), Status::ok);
  EXPECT_EQ(fixture.recorder.record_tick(0, inputs, 1), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.next_tick(), 1U);
}

TEST(Recorder, RefusesInformationOutOfRange) {
  MemorySink sink;
  const SimulationInfo good = ToySimulation(ToyConfig{}).info();
  const auto begins = [&](SimulationInfo info, std::uint64_t start_tick) {
    return Recorder(sink).begin(info, {}, {.start_tick = start_tick});
  };
  SimulationInfo info = good;
  info.player_count = k_max_players + 1;
  EXPECT_EQ(begins(info, 0), Status::invalid_argument);
  info = good;
  info.input_bytes = 65;
  EXPECT_EQ(begins(info, 0), Status::invalid_argument);
  info = good;
  info.tick_rate = 0;
  EXPECT_EQ(begins(info, 0), Status::invalid_argument);
  EXPECT_EQ(begins(good, k_max_start_tick + 1), Status::invalid_argument);
  EXPECT_TRUE(sink.bytes().empty());
}

TEST(Recorder, DemandsAKeyframeWhenTheLogStartsLater) {
  Fixture fixture;
  fixture.game.step(fixture.inputs.at(0));
  ASSERT_EQ(fixture.begin(1), Status::ok);
  EXPECT_TRUE(fixture.recorder.keyframe_due());
  EXPECT_EQ(fixture.recorder.record_tick(1, fixture.inputs.at(1), 1), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.keyframe(fixture.game), Status::ok);
  EXPECT_FALSE(fixture.recorder.keyframe_due());
  EXPECT_EQ(fixture.play(), Status::ok);
}

TEST(Recorder, RefusesAKeyframeOfAnotherStateOrBeyondItsRoom) {
  Fixture fixture;
  ASSERT_EQ(fixture.begin(), Status::ok);
  ASSERT_EQ(fixture.play(), Status::ok);
  const std::array<std::byte, 3> snapshot{};
  const Bytes huge((1U << 16) + 1);
  EXPECT_EQ(fixture.recorder.keyframe(0, fixture.game.hash(), snapshot), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.keyframe(1, 12345, snapshot), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.keyframe(1, fixture.game.hash(), {}), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.keyframe(1, fixture.game.hash(), huge), Status::capacity_exhausted);
  ASSERT_TRUE(fixture.game.flip_bit("body", 0, "heat", 3));
  EXPECT_EQ(fixture.recorder.keyframe(fixture.game), Status::invalid_argument);
  ASSERT_TRUE(fixture.game.flip_bit("body", 0, "heat", 3));
  EXPECT_EQ(fixture.recorder.keyframe(fixture.game), Status::ok);
  EXPECT_EQ(fixture.recorder.finish("x"), Status::ok);
  EXPECT_EQ(verify_toy(fixture.sink.bytes()).outcome, VerifyOutcome::same);
}

TEST(Recorder, CutsAndCleansText) {
  Fixture fixture;
  ASSERT_EQ(fixture.begin(), Status::ok);
  EXPECT_EQ(fixture.recorder.event(0, EventKind::note, 2, "x"), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.event(0, EventKind{0}, 0, "x"), Status::invalid_argument);
  EXPECT_EQ(fixture.recorder.event(0, EventKind::note, 1, "a\n\x1b[31m\x7f"), Status::ok);
  EXPECT_EQ(
      fixture.recorder.event(0, EventKind::leave, k_no_slot, std::string(255, 'z') + "\u00e9"),
      Status::ok);
  EXPECT_EQ(fixture.recorder.finish(std::string(999, 'r')), Status::ok);
  MemorySource source(fixture.sink.bytes());
  LogReader reader(source);
  ASSERT_EQ(reader.open(), Status::ok);
  ASSERT_EQ(reader.next(), LogItem::scene);
  ASSERT_EQ(reader.next(), LogItem::events);
  ASSERT_EQ(reader.events().size(), 2U);
  EXPECT_EQ(reader.events()[0].text, "a??[31m?");
  EXPECT_EQ(reader.events()[1].text, std::string(255, 'z') + '?');  // half a character was left
  ASSERT_EQ(reader.next(), LogItem::skipped);                       // the index
  ASSERT_EQ(reader.next(), LogItem::end);
  EXPECT_EQ(reader.end().reason.size(), k_max_text_bytes);
}

TEST(Recorder, KeepsMoreEventsThanItsBufferHolds) {
  Fixture fixture;
  ASSERT_EQ(fixture.begin(), Status::ok);
  for (int i = 0; i < 500; ++i) {
    if (i % 100 == 0) {
      ASSERT_EQ(fixture.play(), Status::ok);
    }
    ASSERT_EQ(fixture.recorder.event(0, EventKind::note, 0, std::string(200, 'n')), Status::ok);
  }
  ASSERT_EQ(fixture.recorder.finish("x"), Status::ok);
  const VerifyReport report = verify_toy(fixture.sink.bytes());
  EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.ticks_verified, 5U);
}

TEST(Recorder, FullDiskIsAnErrorAndLeavesALogThatVerifies) {
  const ToyMatch match;
  const Bytes whole = record(match);
  const std::size_t header_bytes = chunks_of(whole)[0].offset;
  for (std::size_t capacity = 0; capacity < whole.size(); ++capacity) {
    FullDisk disk(capacity);
    ASSERT_EQ(record(match, disk), Status::io_error) << capacity;
    EXPECT_EQ(disk.refusals, 1) << "a failed recorder does not write again";
    ASSERT_TRUE(std::equal(disk.bytes().begin(), disk.bytes().end(), whole.begin()));
    const VerifyReport report = verify_toy(disk.bytes());
    const bool has_header = capacity >= header_bytes;
    EXPECT_EQ(report.outcome, has_header ? VerifyOutcome::same : VerifyOutcome::corrupt);
    EXPECT_FALSE(report.complete);
  }
}

TEST(Recorder, StaysFailedAfterAnError) {
  FullDisk disk(10);
  Recorder recorder(disk);
  const ToySimulation game(ToyConfig{});
  ToyInputs inputs{ToyConfig{}};
  EXPECT_EQ(recorder.begin(game.info(), {}, {}), Status::io_error);
  EXPECT_EQ(recorder.record_tick(0, inputs.at(0), 1), Status::io_error);
  EXPECT_EQ(recorder.event(0, EventKind::note, 0, ""), Status::io_error);
  EXPECT_EQ(recorder.flush(), Status::io_error);
  EXPECT_EQ(recorder.finish("x"), Status::io_error);
  EXPECT_FALSE(recorder.keyframe_due());
}

TEST(Recorder, RewritingWithoutChangeGivesTheSameBytes) {
  const Bytes log = record({.ticks = 77});
  EXPECT_EQ(rewrite(log, {}), log);
}

}  // namespace
}  // namespace lockstone::test
