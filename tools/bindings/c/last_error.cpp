// The message of each thread's last failing call.
#include <array>

#include "tools/bindings/c/call.h"

namespace lockstone::c {
namespace {

thread_local std::array<char, 512> message_of_thread{};

}  // namespace

lks_status remember(lks_status status, std::string_view message) noexcept {
  write_text(message, message_of_thread.data(), message_of_thread.size());
  return status;
}

}  // namespace lockstone::c

const char* lks_last_error(void) {
  return lockstone::c::message_of_thread.data();
}
