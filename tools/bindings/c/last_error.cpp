// Exceptions become a status, and the message of each thread's last failing call.
#include <array>
#include <exception>
#include <new>

#include "tools/bindings/c/call.h"

namespace lockstone::c {
namespace {

thread_local std::array<char, 512> message_of_thread{};

}  // namespace

lks_status remember(lks_status status, std::string_view message) noexcept {
  write_text(message, message_of_thread.data(), message_of_thread.size());
  return status;
}

lks_status call_guarded(void (*function)(void* body), void* body) noexcept {
  try {
    function(body);
    return LKS_OK;
  } catch (const Failure& failure) {
    return remember(failure.status, failure.message);
  } catch (const std::bad_alloc&) {
    return remember(LKS_OUT_OF_MEMORY, "not enough memory");
  } catch (const std::exception& error) {
    return remember(LKS_INTERNAL, error.what());
  } catch (...) {
    return remember(LKS_INTERNAL, "unknown exception");
  }
}

}  // namespace lockstone::c

const char* lks_last_error(void) {
  return lockstone::c::message_of_thread.data();
}
