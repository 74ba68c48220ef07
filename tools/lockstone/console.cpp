#include "tools/lockstone/console.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <unistd.h>

namespace lockstone::tool {

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

void complain(const std::string& line) {
  fmt::print(stderr, "lockstone: {}\n", line);
}

std::optional<std::string> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file) return std::nullopt;
  return text;
}

bool write_text_file(const std::string& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  bool ok = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (file != nullptr) ok = std::fclose(file) == 0 && ok;
  if (!ok) complain(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  return ok;
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
  show(fmt::format("{} [{:<{}}] {}/{}", label, std::string(static_cast<std::size_t>(filled), '#'), k_width, done, total));
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
