// The program's function for messages.
#include <array>
#include <mutex>

#include "tools/bindings/c/game_handles.h"

namespace lockstone::c {
namespace {

struct LogHook {
  lks_log_function write = nullptr;
  void* user = nullptr;
};

std::mutex hook_mutex;
LogHook hook;

LogHook current_hook() {
  const std::lock_guard lock(hook_mutex);
  return hook;
}

}  // namespace

void say(std::uint32_t level, std::string_view text) noexcept {
  const LogHook to = current_hook();
  if (to.write == nullptr) return;
  std::array<char, 512> line;
  write_text(text, line.data(), line.size());
  to.write(to.user, level, line.data());
}

}  // namespace lockstone::c

lks_status lks_set_log(lks_log_function write, void* user) {
  const std::lock_guard lock(lockstone::c::hook_mutex);
  lockstone::c::hook = {write, user};
  return LKS_OK;
}
