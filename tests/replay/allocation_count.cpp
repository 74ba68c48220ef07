#include "tests/replay/allocation_count.h"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

namespace {

lockstone::test::HeapUse g_use;

}  // namespace

namespace lockstone::test {

HeapUse take_heap_use() {
  return std::exchange(g_use, HeapUse{});
}

}  // namespace lockstone::test

void* operator new(std::size_t bytes) {
  ++g_use.allocations;
  g_use.largest_bytes = std::max(g_use.largest_bytes, bytes);
  if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
