// Logs as files of the operating system, and recorders that are killed.
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include <lockstone/replay/sink.h>
#include <lockstone/replay/source.h>

#include "tests/replay/log_tools.h"

#if defined(__unix__)
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace lockstone::test {
namespace {

using namespace replay;

// A path in the directory for temporary files, removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_(
            std::filesystem::path(::testing::TempDir()) /
            (name + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()))) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::uint64_t bytes() const {
    std::error_code error;
    const auto size = std::filesystem::file_size(path_, error);
    return error ? 0 : size;
  }

 private:
  std::filesystem::path path_;
};

TEST(File, HoldsTheSameBytesAsMemory) {
  const TemporaryFile file("lockstone_same");
  auto sink = FileSink::create(file.path());
  ASSERT_TRUE(sink.ok());
  ASSERT_EQ(record({.ticks = 50}, *sink.value()), Status::ok);
  auto source = FileSource::open(file.path());
  ASSERT_TRUE(source.ok());
  const Bytes expected = record({.ticks = 50});
  ASSERT_EQ(source.value()->size(), expected.size());
  Bytes bytes(expected.size());
  ASSERT_EQ(source.value()->read_at(0, bytes), Status::ok);
  EXPECT_EQ(bytes, expected);
  EXPECT_EQ(verify(*source.value(), toy_factory()).outcome, VerifyOutcome::same);
}

TEST(File, AMissingFileAndADirectoryAreTypedErrors) {
  EXPECT_EQ(FileSource::open(::testing::TempDir() + "/lockstone/none.lks").status(),
            Status::not_found);
  EXPECT_EQ(FileSource::open(::testing::TempDir()).status(), Status::io_error);
  EXPECT_EQ(FileSink::create(::testing::TempDir() + "/lockstone/none.lks").status(),
            Status::io_error);
}

TEST(File, AnEmptyFileIsATruncatedLog) {
  const TemporaryFile file("lockstone_empty");
  std::ofstream(file.path()).flush();
  auto source = FileSource::open(file.path());
  ASSERT_TRUE(source.ok());
  const VerifyReport report = verify(*source.value(), toy_factory());
  EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
  EXPECT_EQ(report.damage->status, Status::truncated);
}

TEST(File, IsReplacedOnlyWhenThatIsAskedFor) {
  const TemporaryFile file("lockstone_there");
  std::ofstream(file.path()) << "precious";
  EXPECT_EQ(FileSink::create(file.path(), false).status(), Status::io_error);
  EXPECT_EQ(file.bytes(), 8U);
  EXPECT_TRUE(FileSink::create(file.path(), true).ok());
  EXPECT_EQ(file.bytes(), 0U);
}

#if defined(__unix__)
TEST(File, AFifoOrADeviceIsATypedErrorAtOnce) {
  const TemporaryFile fifo("lockstone_fifo");
  ASSERT_EQ(::mkfifo(fifo.path().c_str(), 0600), 0);
  for (const std::string& path :
       {fifo.path(), std::string("/dev/null"), std::string("/dev/zero")}) {
    EXPECT_EQ(FileSource::open(path).status(), Status::io_error) << path;
    EXPECT_EQ(FileSink::create(path).status(), Status::io_error) << path;
    EXPECT_EQ(FileSink::create(path, false).status(), Status::io_error) << path;
  }
  // Also with somebody at the other end.
  const int other_end = ::open(fifo.path().c_str(), O_RDWR | O_NONBLOCK);
  ASSERT_GE(other_end, 0);
  EXPECT_EQ(FileSource::open(fifo.path()).status(), Status::io_error);
  EXPECT_EQ(FileSink::create(fifo.path()).status(), Status::io_error);
  ::close(other_end);
}

// The disk is full for a process that may write no longer files.
TEST(File, AFullDiskIsATypedErrorWithItsCause) {
  const TemporaryFile file("lockstone_full");
  auto sink = FileSink::create(file.path());
  ASSERT_TRUE(sink.ok());
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = ::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit full { 100, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  const Status status = record({}, *sink.value());
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(status, Status::io_error);
  EXPECT_EQ(sink.value()->system_error(), EFBIG);
}

[[noreturn]] void record_until_killed(const std::string& path) {
  auto sink = FileSink::create(path);
  if (!sink) ::_exit(1);
  (void)record({.ticks = ~std::uint64_t{0}, .keyframe_interval = 600, .chunk_ticks = 0},
               *sink.value());
  ::_exit(1);
}

TEST(File, ARecorderKilledAtAnyTimeLeavesALogThatVerifies) {
  for (int round = 0; round < 5; ++round) {
    const TemporaryFile file("lockstone_killed");
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_until_killed(file.path());
    while (file.bytes() < 20'000)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::microseconds(700 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    auto source = FileSource::open(file.path());
    ASSERT_TRUE(source.ok());
    const VerifyReport report = verify(*source.value(), toy_factory());
    EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
    EXPECT_GE(report.ticks_verified, 60U);
    EXPECT_FALSE(report.complete);
  }
}
#endif

}  // namespace
}  // namespace lockstone::test
