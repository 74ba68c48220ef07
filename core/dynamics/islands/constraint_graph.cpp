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
  std::fill(std::begin(counts_), std::end(counts_), 0U);
  size_ = 0;
}

std::uint32_t ConstraintGraph::greatest_count() const {
  return *std::max_element(counts_, counts_ + k_graph_colors);
}

// A constraint gets the first colour free at both bodies: none below one in use is empty.
std::uint32_t ConstraintGraph::colors() const {
  const std::uint32_t* const end = counts_ + k_graph_colors;
  return static_cast<std::uint32_t>(std::find(counts_, end, 0U) - counts_);
}

}  // namespace lockstone
