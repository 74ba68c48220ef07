// Watches the program's heap: this test program replaces the global operator new.
#pragma once

#include <cstddef>

namespace lockstone::test {

struct HeapUse {
  std::size_t allocations = 0;
  std::size_t largest_bytes = 0;  ///< the largest single allocation
  std::size_t peak_bytes = 0;     ///< the most that was held at once, beyond the bytes held before
};

/// Heap use since the last call.
HeapUse take_heap_use();

}  // namespace lockstone::test
