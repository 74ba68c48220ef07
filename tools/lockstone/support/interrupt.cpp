#include "tools/lockstone/support/interrupt.h"

#include <csignal>

namespace lockstone::tool {
namespace {

volatile std::sig_atomic_t g_interrupted = 0;

void note(int) {
  g_interrupted = 1;
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() {
  return g_interrupted != 0;
}

}  // namespace lockstone::tool
