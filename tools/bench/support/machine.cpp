#include "tools/bench/support/machine.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include <sys/wait.h>

namespace lockstone::bench {
namespace {

std::string first_line_of(const std::string& command) {
  std::string first;
  bool taken = false;
  for_lines_of(command, [&](std::string&& line) {
    if (!taken) first = std::move(line);
    taken = true;
  });
  return first;
}

}  // namespace

std::string machine_text() {
  constexpr std::string_view k_mark = "model name";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with(k_mark) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string compiler_text() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

std::string commit_text() {
  const std::string commit = first_line_of("git rev-parse --short HEAD 2>/dev/null");
  if (commit.empty()) return "unknown";
  const std::string changed = first_line_of("git status --porcelain -uno 2>/dev/null");
  return changed.empty() ? commit : commit + "-dirty";
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'')
      result += "'\\''";
    else
      result += c;
  }
  return result + "'";
}

int for_lines_of(const std::string& command, const std::function<void(std::string&&)>& take) {
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  std::array<char, 65536> buffer{};
  std::string line;
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) {
    line += buffer.data();
    if (!line.ends_with('\n')) continue;
    line.pop_back();
    take(std::move(line));
    line.clear();
  }
  if (!line.empty()) take(std::move(line));
  const int status = pclose(pipe);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string own_program() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? "lockstone" : self.string();
}

}  // namespace lockstone::bench
