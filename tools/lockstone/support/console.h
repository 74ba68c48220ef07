// Input and output that the subcommands share: hashes, progress, files.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace lockstone::tool {

/// Sixteen lower-case hexadecimal digits.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

/// The name that begins each complaint; "lockstone" until it is set, before the first thread
/// starts.
void set_program_name(std::string name);
[[nodiscard]] const std::string& program_name();

/// A line on the standard error stream.
void complain(const std::string& line);

/// The contents of the file, or nothing when it cannot be read. A directory, a FIFO or a device
/// cannot, which is found at once.
[[nodiscard]] std::optional<std::string> read_file(const std::string& path);

/// Seconds since its creation.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }
  [[nodiscard]] std::int64_t microseconds() const {
    return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// One line on a terminal's standard error stream that is drawn over and over; nothing when that is
/// not a terminal. At most ten times a second.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A bar. `total` 0: unknown.
  void show(const std::string& label, std::uint64_t done, std::uint64_t total);
  void show(const std::string& line);

  /// Removes the line, so that something else can be printed.
  void clear();

 private:
  bool enabled_;
  bool drawn_ = false;
  double next_seconds_ = 0;
  Stopwatch watch_;
};

}  // namespace lockstone::tool
