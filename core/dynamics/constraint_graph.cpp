#include "core/dynamics/constraint_graph.h"

#include <algorithm>
#include <bit>

namespace lockstone {

ConstraintGraph::ConstraintGraph(std::size_t body_capacity, std::size_t constraint_capacity) {
  taken_.reserve(body_capacity + 1);
  places_.reserve(constraint_capacity);
  clear();
}

void ConstraintGraph::clear() {
  taken_.clear();
  add_body();
  std::fill(std::begin(counts_), std::end(counts_), 0U);
  places_.clear();
}

void ConstraintGraph::add(std::uint32_t body_a, bool pushed_a, std::uint32_t body_b,
                          bool pushed_b) {
  const std::uint32_t taken = (pushed_a ? taken_[body_a] : 0U) | (pushed_b ? taken_[body_b] : 0U);
  const auto color = static_cast<std::uint32_t>(std::countr_one(taken));
  if (color < k_graph_colors) {
    const std::uint32_t bit = 1U << color;
    if (pushed_a) taken_[body_a] |= bit;
    if (pushed_b) taken_[body_b] |= bit;
  }
  places_.push_back({color, counts_[color]++});
}

// A constraint gets the first colour free at both bodies: none below one in use is empty.
std::uint32_t ConstraintGraph::colors() const {
  const std::uint32_t* const end = counts_ + k_graph_colors;
  return static_cast<std::uint32_t>(std::find(counts_, end, 0U) - counts_);
}

}  // namespace lockstone
