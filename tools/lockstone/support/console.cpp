#include "tools/lockstone/support/console.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace lockstone::tool {

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

static std::string& program_name_text() {
  static std::string name = "lockstone";
  return name;
}

void set_program_name(std::string name) {
  program_name_text() = std::move(name);
}

const std::string& program_name() {
  return program_name_text();
}

void complain(const std::string& line) {
  fmt::print(stderr, "{}: {}\n", program_name(), line);
}

// Opening a FIFO would wait for its other end.
std::optional<std::string> read_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file) return std::nullopt;
  return text;
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
