#include "tools/lockstone/support/interrupt.h"

#include <csignal>

namespace lockstone::tool {
namespace {

volatile std::sig_atomic_t g_interrupts = 0;
volatile std::sig_atomic_t g_terminations = 0;

void note(int signal) {
  if (signal == SIGTERM && g_terminations < 2)
    g_terminations = g_terminations + 1;
  else
    g_interrupts = 1;
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() {
  return g_interrupts != 0 || g_terminations != 0;
}

bool asked_to_end() {
  return g_interrupts == 0 && g_terminations == 1;
}

}  // namespace lockstone::tool
