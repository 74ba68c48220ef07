#include "tests/replay/allocation_count.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

namespace {

// In front of each block, its length; as long as the strictest alignment.
constexpr std::size_t k_front_bytes = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

lockstone::test::HeapUse g_use;
std::atomic<std::size_t> g_held_bytes = 0;
std::size_t g_held_before = 0;

}  // namespace

namespace lockstone::test {

HeapUse take_heap_use() {
  g_held_before = g_held_bytes;
  return std::exchange(g_use, HeapUse{});
}

}  // namespace lockstone::test

void* operator new(std::size_t bytes) {
  ++g_use.allocations;
  g_use.largest_bytes = std::max(g_use.largest_bytes, bytes);
  const std::size_t held_bytes = g_held_bytes += bytes;
  if (held_bytes > g_held_before)
    g_use.peak_bytes = std::max(g_use.peak_bytes, held_bytes - g_held_before);
  void* memory = std::malloc(k_front_bytes + bytes);
  if (memory == nullptr) throw std::bad_alloc();
  std::memcpy(memory, &bytes, sizeof(bytes));
  return static_cast<char*>(memory) + k_front_bytes;
}

void operator delete(void* memory) noexcept {
  if (memory == nullptr) return;
  char* front = static_cast<char*>(memory) - k_front_bytes;
  std::size_t bytes = 0;
  std::memcpy(&bytes, front, sizeof(bytes));
  g_held_bytes -= bytes;
  std::free(front);
}
void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}
