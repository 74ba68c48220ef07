#include "replay/files/regular_file.h"

#include <cerrno>

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace lockstone::replay {

#if defined(__unix__) || defined(__APPLE__)
namespace {

// Without O_NONBLOCK, opening a FIFO would wait for its other end. It changes nothing for files.
int flags_of(OpenFor purpose) {
  constexpr int k_always = O_NONBLOCK | O_CLOEXEC;
  if (purpose == OpenFor::reading) return O_RDONLY | k_always;
  return O_WRONLY | O_CREAT | k_always | (purpose == OpenFor::creating ? O_EXCL : 0);
}

bool is_regular(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

}  // namespace

// Nothing is emptied before it is known to be a file.
Result<std::FILE*> open_regular(const std::string& path, OpenFor purpose) {
  const int descriptor = ::open(path.c_str(), flags_of(purpose), 0666);
  if (descriptor < 0) {
    return purpose == OpenFor::reading && errno == ENOENT ? Status::not_found : Status::io_error;
  }
  const bool ready =
      is_regular(descriptor) && (purpose != OpenFor::replacing || ::ftruncate(descriptor, 0) == 0);
  std::FILE* file =
      ready ? ::fdopen(descriptor, purpose == OpenFor::reading ? "rb" : "wb") : nullptr;
  if (file != nullptr) return file;
  ::close(descriptor);
  return Status::io_error;
}
#else
Result<std::FILE*> open_regular(const std::string& path, OpenFor purpose) {
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), purpose == OpenFor::replacing ? "wb" : "rb");
  if (purpose == OpenFor::creating) {
    if (file != nullptr) std::fclose(file);
    file = file == nullptr ? std::fopen(path.c_str(), "wb") : nullptr;
  }
  if (file != nullptr) return file;
  return purpose == OpenFor::reading && errno == ENOENT ? Status::not_found : Status::io_error;
}
#endif

}  // namespace lockstone::replay
