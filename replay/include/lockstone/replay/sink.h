// Where a recorder puts its bytes.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// Append-only. A recorder makes one call for each group of chunks and never repeats a failed one.
class Sink {
 public:
  virtual ~Sink() = default;

  /// Appends `bytes`. After ok they survive the death of this process. After an error some of them
  /// may have been written: the log then ends in a torn tail, which readers expect.
  virtual Status append(ByteView bytes) = 0;
};

/// A file of the operating system. Nothing is buffered in the process: a killed recorder loses
/// nothing that append() returned ok for. (A power cut may: the file is not synced to the disk.)
class FileSink final : public Sink {
 public:
  /// Creates `path`; with `replace`, empties the file that is there. io_error when the system
  /// refuses, when there is a file and `replace` is false, and, at once, for a directory, a FIFO or
  /// a device.
  [[nodiscard]] static Result<std::unique_ptr<FileSink>> create(const std::string& path,
                                                                bool replace = true);

  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;
  ~FileSink() override;

  /// io_error when the system wrote less: see system_error().
  Status append(ByteView bytes) override;

  /// errno of the last failed append (ENOSPC: the disk is full), else 0.
  [[nodiscard]] int system_error() const { return system_error_; }

 private:
  explicit FileSink(std::FILE* file) : file_(file) {}

  std::FILE* file_;
  int system_error_ = 0;
};

/// A growing buffer. Allocates as it grows, unless `reserve_bytes` was enough.
class MemorySink final : public Sink {
 public:
  explicit MemorySink(std::size_t reserve_bytes = 0) { bytes_.reserve(reserve_bytes); }

  Status append(ByteView bytes) override;

  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace lockstone::replay
