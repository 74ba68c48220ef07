#include "core/dynamics/islands/constraint_graph.h"

#include <algorithm>

namespace lockstone {

ConstraintGraph::ConstraintGraph(std::size_t body_capacity, std::size_t constraint_capacity)
    : places_(new Place[constraint_capacity]) {
  taken_.reserve(body_capacity + 1);
  clear();
}

void ConstraintGraph::clear() {
  taken_.clear();
  add_body();
  for (auto& counts : counts_)
    counts.fill(0);
  size_ = 0;
}

std::uint32_t ConstraintGraph::greatest_count() const {
  std::uint32_t most = 0;
  for (std::size_t color = 0; color < k_graph_colors; ++color)
    most = std::max(most, count(color));
  return most;
}

// A constraint gets the first colour free at both bodies: none below one in use is empty.
std::uint32_t ConstraintGraph::colors() const {
  std::uint32_t color = 0;
  while (color < k_graph_colors && count(color) != 0)
    ++color;
  return color;
}

}  // namespace lockstone
