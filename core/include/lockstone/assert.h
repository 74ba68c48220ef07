// Checks. LKS_CHECK is always on; LKS_ASSERT is on in debug builds and in tests.
// Both stop the program: they report a programmer's error, never bad bytes from outside.
// The level never changes a result: a check reads state and writes nothing.
#pragma once

#include <cstdint>

namespace lockstone {

/// Prints `expression` with its place to the standard error stream and aborts.
[[noreturn]] void check_failed(const char* expression, const char* file, int line);

/// Prints `text`, which names the public function that was misused and the remedy, and aborts.
[[noreturn]] void misused(const char* text);

/// The same of a handle: "World::position: handle {3, 1} names no body; …".
[[noreturn]] void misused(const char* function, std::uint32_t index, std::uint32_t generation,
                          const char* text);

}  // namespace lockstone

#define LKS_CHECK(expression) \
  ((expression) ? static_cast<void>(0) : ::lockstone::check_failed(#expression, __FILE__, __LINE__))

#if defined(LKS_ENABLE_ASSERTS)
#define LKS_ASSERT(expression) LKS_CHECK(expression)
#else
#define LKS_ASSERT(expression) static_cast<void>(0)
#endif
