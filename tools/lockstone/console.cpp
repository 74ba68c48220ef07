#include "tools/lockstone/console.h"

#include <array>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lockstone::tool {

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

void complain(const std::string& line) {
  fmt::print(stderr, "lockstone: {}\n", line);
}

// Without O_NONBLOCK, opening a FIFO would wait for its other end.
std::optional<std::string> read_file(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  struct stat status {};
  bool good = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  std::string text;
  std::array<char, 65536> piece{};
  for (ssize_t got = 1; good && got > 0;) {
    got = read(file, piece.data(), piece.size());
    good = got >= 0;
    if (got > 0) text.append(piece.data(), static_cast<std::size_t>(got));
  }
  close(file);
  return good ? std::optional(std::move(text)) : std::nullopt;
}

Progress::Progress() : enabled_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  clear();
}

void Progress::show(const std::string& label, std::uint64_t done, std::uint64_t total) {
  constexpr std::uint64_t k_width = 32;
  if (!enabled_ || watch_.seconds() < next_seconds_) return;
  if (total == 0) return show(fmt::format("{} {}", label, done));
  const std::uint64_t filled = done >= total ? k_width : done * k_width / total;
  show(fmt::format("{} [{:<{}}] {}/{}", label, std::string(static_cast<std::size_t>(filled), '#'),
                   k_width, done, total));
}

void Progress::show(const std::string& line) {
  if (!enabled_ || watch_.seconds() < next_seconds_) return;
  next_seconds_ = watch_.seconds() + 0.1;
  fmt::print(stderr, "\r\x1b[K{}", line);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace lockstone::tool
