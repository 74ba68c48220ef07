#include "tests/replay/allocation_count.h"

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

// In front of each block, its length; as long as the strictest alignment.
constexpr std::size_t k_front_bytes = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

// Several threads of a program allocate.
std::atomic<std::size_t> g_allocations = 0, g_largest_bytes = 0, g_peak_bytes = 0;
std::atomic<std::size_t> g_held_bytes = 0, g_held_before = 0;

void raise_to(std::atomic<std::size_t>& most, std::size_t value) {
  std::size_t known = most;
  while (known < value && !most.compare_exchange_weak(known, value)) {
  }
}

}  // namespace

namespace lockstone::test {

HeapUse take_heap_use() {
  g_held_before = g_held_bytes.load();
  return {g_allocations.exchange(0), g_largest_bytes.exchange(0), g_peak_bytes.exchange(0)};
}

}  // namespace lockstone::test

void* operator new(std::size_t bytes) {
  ++g_allocations;
  raise_to(g_largest_bytes, bytes);
  const std::size_t held_bytes = g_held_bytes += bytes, held_before = g_held_before;
  if (held_bytes > held_before) raise_to(g_peak_bytes, held_bytes - held_before);
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
