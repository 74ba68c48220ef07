#include <cstdio>
#include <cstdlib>

#include <lockstone/assert.h>

namespace lockstone {

void check_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "lockstone: check failed: %s (%s:%d)\n", expression, file, line);
  std::abort();
}

}  // namespace lockstone
