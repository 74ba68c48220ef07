#include "tools/lockstone/match/secrets.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

std::optional<std::string> read_line(const std::string& path) {
  std::optional<std::string> text = read_file(path);
  if (!text) {
    complain(fmt::format("cannot read {}", path));
    return std::nullopt;
  }
  while (!text->empty() && (text->back() == '\n' || text->back() == '\r'))
    text->pop_back();
  return text;
}

template <class T>
std::optional<T> read_as(const std::string& path, const char* what) {
  const std::optional<std::string> text = read_line(path);
  if (!text) return std::nullopt;
  const Result<T> parsed = T::from_text(*text);
  if (parsed) return parsed.value();
  complain(fmt::format("{} is no {}: {}", path, what, to_string(parsed.status())));
  return std::nullopt;
}

}  // namespace

std::optional<net::Key> read_key(const std::string& path) {
  return read_as<net::Key>(path, "key");
}

std::optional<net::ConnectToken> read_token(const std::string& path) {
  return read_as<net::ConnectToken>(path, "token");
}

bool write_secret_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
  const bool written =
      file >= 0 && write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const bool ok = file >= 0 && close(file) == 0 && written;
  if (!ok) complain(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
  return ok;
}

std::int64_t unix_microseconds() {
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(since_1970).count();
}

std::uint64_t unix_seconds() {
  return static_cast<std::uint64_t>(unix_microseconds() / 1'000'000);
}

bool require_security() {
  if (net::security_available()) return true;
  complain("this build cannot encrypt: it has no libsodium");
  return false;
}

PrivateFolder::PrivateFolder() {
  std::error_code error;
  std::string pattern = (std::filesystem::temp_directory_path(error) / "lockstone-XXXXXX").string();
  if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace lockstone::tool
