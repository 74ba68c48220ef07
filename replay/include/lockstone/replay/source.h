// Where a reader takes its bytes from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// Bytes at offsets. A log is never loaded whole: a reader asks for one chunk at a time.
class Source {
 public:
  virtual ~Source() = default;

  /// Bytes in all, fixed when the source was opened: bytes that a recorder appends later are not
  /// seen.
  [[nodiscard]] virtual std::uint64_t size() const = 0;

  /// Fills `out` from `offset`. Never called beyond size(). io_error when the system gives less.
  virtual Status read_at(std::uint64_t offset, std::span<std::byte> out) = 0;
};

/// A seekable file of the operating system.
class FileSource final : public Source {
 public:
  /// not_found when there is no such file; io_error when it cannot be read, and, at once, for a
  /// directory, a FIFO or a device.
  [[nodiscard]] static Result<std::unique_ptr<FileSource>> open(const std::string& path);

  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;
  ~FileSource() override;

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  Status read_at(std::uint64_t offset, std::span<std::byte> out) override;

 private:
  FileSource(std::FILE* file, std::uint64_t size) : file_(file), size_(size) {}

  std::FILE* file_;
  std::uint64_t size_;
  std::uint64_t position_ = 0;
};

/// Bytes that the caller keeps alive.
class MemorySource final : public Source {
 public:
  explicit MemorySource(ByteView bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  Status read_at(std::uint64_t offset, std::span<std::byte> out) override;

 private:
  ByteView bytes_;
};

}  // namespace lockstone::replay
