#include "core/dynamics/islands/tick_islands.h"

#include <lockstone/assert.h>

namespace lockstone {

TickIslands::TickIslands(std::size_t row_capacity, std::size_t body_capacity) {
  parents_.reserve(row_capacity);
  tallies_.reserve(body_capacity + 1);
}

void TickIslands::clear() {
  parents_.assign(1, 0);
}

void TickIslands::settle() {
  std::uint32_t count = 0;
  // A parent comes before its children, so it has its island when they ask for it.
  for (std::uint32_t body = 0; body < parents_.size(); ++body) {
    const std::uint32_t parent = parents_[body];
    LKS_ASSERT(parent <= body);
    parents_[body] = parent == body ? count++ : parents_[parent];
  }
  tallies_.assign(count, {});
}

}  // namespace lockstone
