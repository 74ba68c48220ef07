#include "core/dynamics/tick_islands.h"

namespace lockstone {

TickIslands::TickIslands(std::size_t body_capacity) {
  parents_.reserve(body_capacity);
  island_.reserve(body_capacity);
  loads_.reserve(body_capacity);
}

void TickIslands::clear() {
  parents_.assign(1, 0);
}

void TickIslands::settle() {
  island_.resize(parents_.size());
  std::uint32_t count = 0;
  // The root of an island is its first body, so it has its number when others ask for it.
  for (std::uint32_t body = 0; body < parents_.size(); ++body) {
    const std::uint32_t first = root(body);
    island_[body] = first == body ? count++ : island_[first];
  }
  loads_.assign(count, {});
}

}  // namespace lockstone
