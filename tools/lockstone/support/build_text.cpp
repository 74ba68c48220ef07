#include "tools/lockstone/support/build_text.h"

#include <fstream>

namespace lockstone::tool {
namespace {

constexpr std::size_t k_most_characters = 64;

// As the system reports it; else as the compiler knows it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return sizeof(void*) == 8 ? "64 bits" : "32 bits";
}

}  // namespace

std::string build_text(const std::string& program) {
  const std::string text = program + ", " __VERSION__ ", " + processor();
  return text.substr(0, k_most_characters);
}

}  // namespace lockstone::tool
