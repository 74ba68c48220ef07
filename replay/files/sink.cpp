#include <cerrno>

#include <lockstone/replay/sink.h>

#include "replay/files/regular_file.h"

namespace lockstone::replay {

Result<std::unique_ptr<FileSink>> FileSink::create(const std::string& path, bool replace) {
  const Result<std::FILE*> file =
      open_regular(path, replace ? OpenFor::replacing : OpenFor::creating);
  if (!file) return file.status();
  // Each append becomes one write to the system, so there is nothing left to flush.
  std::setvbuf(file.value(), nullptr, _IONBF, 0);
  return std::unique_ptr<FileSink>(new FileSink(file.value()));
}

FileSink::~FileSink() {
  std::fclose(file_);
}

Status FileSink::append(ByteView bytes) {
  // A signal may cut a write short; the rest is then simply written next.
  while (!bytes.empty()) {
    errno = 0;
    bytes = bytes.subspan(std::fwrite(bytes.data(), 1, bytes.size(), file_));
    if (bytes.empty()) break;
    system_error_ = errno;
    if (system_error_ != EINTR) return Status::io_error;
    std::clearerr(file_);
  }
  system_error_ = 0;
  return Status::ok;
}

Status MemorySink::append(ByteView bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return Status::ok;
}

}  // namespace lockstone::replay
