#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <lockstone/assert.h>

namespace lockstone {

void check_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "lockstone: check failed: %s (%s:%d)\n", expression, file, line);
  std::abort();
}

void misused(const char* text) {
  std::fprintf(stderr, "lockstone: %s\n", text);
  std::abort();
}

void misused(const char* function, std::uint32_t index, std::uint32_t generation,
             const char* text) {
  std::fprintf(stderr, "lockstone: %s: handle {%u, %u} %s\n", function,
               static_cast<unsigned>(index), static_cast<unsigned>(generation), text);
  std::abort();
}

}  // namespace lockstone
