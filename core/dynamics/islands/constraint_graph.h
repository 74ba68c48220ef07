// Colours for constraints, so that those of one colour share no body and can be solved side by
// side.
//
// Greedy, in the order in which constraints are added: each gets the first colour that neither of
// its bodies has. Added in canonical order, the colours follow from the state alone. The idea of
// colouring for wide solvers: E. Catto, "SIMD Matters", 2024.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include <lockstone/assert.h>

namespace lockstone {

/// Colours for constraints side by side; a constraint that finds none goes to the overflow colour.
inline constexpr std::size_t k_graph_colors = 32;
inline constexpr std::size_t k_overflow_color = k_graph_colors;

/// Constraints of a colour are of this many kinds at most.
inline constexpr std::size_t k_constraint_kinds = 3;

class ConstraintGraph {
 public:
  /// No function but this allocates.
  ConstraintGraph(std::size_t body_capacity, std::size_t constraint_capacity);

  /// Leaves body 0 alone.
  void clear();

  /// Bodies are named 0, 1, 2, … in the order of adding.
  void add_body() { taken_.push_back(0); }

  /// A body that is not `pushed` conflicts with nothing: constraints may share it. No more are
  /// added than there is room for. The colour does not depend on the kind; in the overflow, whose
  /// constraints are solved in their order, all are of kind 0.
  void add(std::uint32_t body_a, bool pushed_a, std::uint32_t body_b, bool pushed_b,
           std::size_t kind = 0) {
    LKS_ASSERT(kind < k_constraint_kinds);
    LKS_ASSERT(!pushed_a || body_a < taken_.size());
    LKS_ASSERT(!pushed_b || body_b < taken_.size());
    const std::uint32_t taken = (pushed_a ? taken_[body_a] : 0U) | (pushed_b ? taken_[body_b] : 0U);
    const auto color = static_cast<std::uint32_t>(std::countr_one(taken));
    if (color < k_graph_colors) {
      const std::uint32_t bit = 1U << color;
      if (pushed_a) taken_[body_a] |= bit;
      if (pushed_b) taken_[body_b] |= bit;
    } else {
      kind = 0;
    }
    places_[size_++] = {static_cast<std::uint16_t>(color), static_cast<std::uint16_t>(kind),
                        counts_[color][kind]++};
  }

  /// Where a constraint stands: the how-manieth of its colour and kind, in the order of adding.
  struct Place {
    std::uint16_t color;
    std::uint16_t kind;
    std::uint32_t rank;
  };
  [[nodiscard]] std::span<const Place> places() const { return {places_.get(), size_}; }

  /// Constraints of a body, as many as there are colours at most.
  [[nodiscard]] int degree(std::uint32_t body) const { return std::popcount(taken_[body]); }

  /// Constraints of a colour and kind, the overflow included.
  [[nodiscard]] std::uint32_t count(std::size_t color, std::size_t kind) const {
    return counts_[color][kind];
  }
  /// Of all kinds.
  [[nodiscard]] std::uint32_t count(std::size_t color) const {
    return std::accumulate(counts_[color].begin(), counts_[color].end(), 0U);
  }
  /// Of the colour that has most, the overflow left out.
  [[nodiscard]] std::uint32_t greatest_count() const;

  /// Colours in use, the overflow not counted.
  [[nodiscard]] std::uint32_t colors() const;

 private:
  std::vector<std::uint32_t> taken_;  // by body: a bit a colour
  std::unique_ptr<Place[]> places_;   // the first size_, in the order of adding
  std::size_t size_ = 0;
  std::array<std::uint32_t, k_constraint_kinds> counts_[k_graph_colors + 1] = {};
};

}  // namespace lockstone
