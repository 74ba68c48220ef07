// Writing on a thread of its own: the same bytes, never a wait, errors that arrive.
#include <condition_variable>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include <lockstone/replay/background_sink.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

// A disk that waits until it is let go, and may then be full.
class SlowSink final : public Sink {
 public:
  Status append(ByteView bytes) override {
    std::unique_lock lock(mutex_);
    ready_.wait(lock, [&] { return open_; });
    if (bytes_.size() + bytes.size() > room_) return Status::io_error;
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return Status::ok;
  }
  void let_go(std::size_t room = 1U << 30) {
    const std::lock_guard lock(mutex_);
    open_ = true;
    room_ = room;
    ready_.notify_all();
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  std::mutex mutex_;
  std::condition_variable ready_;
  bool open_ = false;
  std::size_t room_ = 0;
  Bytes bytes_;
};

TEST(BackgroundSink, WritesTheSameBytes) {
  const Bytes log = record({.ticks = 500});
  MemorySink memory;
  BackgroundSink sink(memory, 1000);  // wraps around many times
  for (std::size_t done = 0; done < log.size();) {
    const std::size_t piece = std::min<std::size_t>(log.size() - done, 1 + done % 700);
    while (sink.waiting_bytes() + piece > 1000)
      std::this_thread::yield();
    ASSERT_EQ(sink.append(std::span(log).subspan(done, piece)), Status::ok);
    done += piece;
  }
  EXPECT_EQ(sink.close(), Status::ok);
  EXPECT_EQ(memory.bytes(), log);
  EXPECT_EQ(sink.waiting_bytes(), 0U);
}

TEST(BackgroundSink, ASlowDiskDoesNotStallTheTick) {
  const ToyMatch match{.ticks = 200};
  const Bytes expected = record(match);
  SlowSink disk;
  BackgroundSink sink(disk, expected.size());
  EXPECT_EQ(record(match, sink), Status::ok);  // while the disk has taken nothing
  EXPECT_EQ(sink.most_waiting_bytes(), expected.size());
  disk.let_go();
  EXPECT_EQ(sink.close(), Status::ok);
  EXPECT_EQ(disk.bytes(), expected);
}

TEST(BackgroundSink, AFullQueueEndsTheLogAtAChunk) {
  SlowSink disk;
  BackgroundSink sink(disk, 2000);
  EXPECT_EQ(record({.ticks = 500}, sink), Status::capacity_exhausted);
  EXPECT_LE(sink.most_waiting_bytes(), 2000U);
  disk.let_go();
  EXPECT_EQ(sink.close(), Status::capacity_exhausted);
  const VerifyReport report = verify_toy(disk.bytes());
  EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
  EXPECT_FALSE(report.torn_tail);
  EXPECT_GT(report.ticks_verified, 0U);
}

TEST(BackgroundSink, AFullDiskIsReported) {
  SlowSink disk;
  disk.let_go(1000);
  BackgroundSink sink(disk);
  Status status = Status::ok;
  const Bytes piece(300);
  for (int i = 0; i < 100'000 && status == Status::ok; ++i)
    status = sink.append(piece);
  EXPECT_NE(status, Status::ok);
  EXPECT_NE(sink.close(), Status::ok);
  EXPECT_LE(disk.bytes().size(), 1000U);
}

TEST(BackgroundSink, TakesNothingAfterItWasClosed) {
  MemorySink memory;
  BackgroundSink sink(memory);
  EXPECT_EQ(sink.close(), Status::ok);
  EXPECT_EQ(sink.append(Bytes(1)), Status::invalid_argument);
  EXPECT_EQ(sink.close(), Status::ok);
}

}  // namespace
}  // namespace lockstone::test
