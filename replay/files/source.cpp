// Logs may exceed 2 GiB on 32-bit systems.
#define _FILE_OFFSET_BITS 64

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/replay/source.h>

#include "replay/files/regular_file.h"

namespace lockstone::replay {

Result<std::unique_ptr<FileSource>> FileSource::open(const std::string& path) {
  const Result<std::FILE*> opened = open_regular(path, OpenFor::reading);
  if (!opened) return opened.status();
  std::FILE* file = opened.value();
  const auto end = ::fseeko(file, 0, SEEK_END) == 0 ? ::ftello(file) : -1;
  const bool rewound = end >= 0 && ::fseeko(file, 0, SEEK_SET) == 0;
  // Where the system did not report the file's type, a directory opens and seeks; only reading it
  // fails.
  const bool readable = rewound && (end == 0 || std::fgetc(file) != EOF);
  if (!readable || ::fseeko(file, 0, SEEK_SET) != 0) {
    std::fclose(file);
    return Status::io_error;
  }
  return std::unique_ptr<FileSource>(new FileSource(file, static_cast<std::uint64_t>(end)));
}

FileSource::~FileSource() {
  std::fclose(file_);
}

Status FileSource::read_at(std::uint64_t offset, std::span<std::byte> out) {
  LKS_ASSERT(offset <= size_ && out.size() <= size_ - offset);
  // Seeking drops the stream's buffer, so it is left out where the reads are sequential.
  if (offset != position_ && ::fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0) {
    return Status::io_error;
  }
  const std::size_t got = std::fread(out.data(), 1, out.size(), file_);
  position_ = offset + got;
  return got == out.size() ? Status::ok : Status::io_error;
}

Status MemorySource::read_at(std::uint64_t offset, std::span<std::byte> out) {
  LKS_CHECK(offset <= bytes_.size() && out.size() <= bytes_.size() - offset);
  const ByteView from = bytes_.subspan(static_cast<std::size_t>(offset), out.size());
  std::copy(from.begin(), from.end(), out.begin());
  return Status::ok;
}

}  // namespace lockstone::replay
