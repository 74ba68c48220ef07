// Block-sparse Cholesky factors of matrices with six rows a body: one matrix an island.
//
// An island's matrix is K = γ·1 + Σ k·Jᵀ·J with rows |J| ≤ 1 and 0 < k ≤ 1, γ = 2^-14: symmetric,
// and at least γ. Each body's rows and columns are scaled by a power of two such that no entry
// exceeds 1, so all entries of the factor lie within ±1. They have 30 fraction bits; sums have 60,
// and 50 before the scale is known.
// The order of elimination is one of least degree (W. Tinney, J. Walker, "Direct solutions of
// sparse network equations by optimally ordered triangular factorization", 1967).
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/pool_use.h"
#include "core/kernels/proximal/proximal_block.h"

namespace lockstone {

/// The six velocities of a body in an island's problem, or changes of them; two more words are 0.
using BodyVector = lanes::BlockWord;

/// One side of a row, Q30.
using RowSide = std::array<std::int32_t, 6>;

class BodyFactor {
 public:
  /// No island has more bodies.
  static constexpr std::uint32_t k_most_bodies = 256;

  /// No island costs more than this many products of blocks.
  static constexpr std::uint32_t k_most_products = 40000;

  /// The matrix's least eigenvalue is 2^-k_least_bits at least.
  static constexpr int k_least_bits = 14;

  /// An island's place in the pools.
  struct Plan {
    std::uint32_t first_column = 0;
    std::uint32_t bodies = 0;
    std::uint32_t first_block = 0;  // diagonal blocks first, in the order of elimination
    std::uint32_t blocks = 0;
    std::uint32_t first_target = 0;
    std::uint32_t products = 0;  // of blocks, in an elimination
  };

  /// Room for islands of this many bodies and pairs in all. No function but this allocates.
  [[gnu::cold]] BodyFactor(std::size_t body_capacity, std::size_t pair_capacity);

  void clear();

  /// Plans the factor of an island whose bodies are named 0 … bodies − 1, and which has an entry
  /// for each of the pairs. False if it would be too large; then nothing has been planned.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  [[nodiscard]] bool plan(std::uint32_t bodies, std::span<const Pair> pairs, Plan& plan);

  /// Of all islands planned since `clear`.
  [[nodiscard]] PoolUse pool_use() const;
  struct Sizes {
    std::size_t targets, most_blocks, most_targets;
  };
  [[nodiscard]] Sizes sizes() const { return {targets_.size(), block_capacity_, target_capacity_}; }

  /// The block of bodies a ≠ b, and whether a's rows are its rows.
  struct Place {
    std::uint32_t block = 0;
    bool a_is_row = false;
  };
  [[nodiscard]] Place find(const Plan& plan, std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::uint32_t diagonal(const Plan& plan, std::uint32_t body) const {
    return plan.first_block + places_[plan.first_column + body];
  }

  /// Sets the matrix to γ·1.
  void reset(const Plan& plan);

  /// Adds k·xᵀ·y to a block, k in Q30; of a diagonal block only as far as the diagonal.
  void add(std::uint32_t block, const RowSide& x, const RowSide& y, std::int32_t k);

  /// The matrix's blocks, for kernels that add many rows at once; `Place` and `diagonal` name them.
  [[nodiscard]] lanes::BodyBlock& block(std::uint32_t index) { return blocks_[index]; }

  void factor(const Plan& plan);

  /// Solves K·x = b, by body. Returns whether all of x fits in 31 bits; words that do not fit are
  /// clamped.
  [[nodiscard]] bool solve(const Plan& plan, std::span<BodyVector> b);

 private:
  using Block = lanes::BodyBlock;
  using Column = lanes::FactorColumn;
  using Below = lanes::BelowDiagonal;
  static constexpr std::size_t k_side = lanes::k_body_words;

  using Set = std::bitset<k_most_bodies>;

  [[nodiscard]] std::uint32_t eliminate_next(std::uint32_t bodies);
  [[nodiscard]] std::uint32_t find_block(const Plan& plan, std::uint32_t row,
                                         std::uint32_t column) const;
  [[nodiscard]] std::size_t find_order(const Plan& plan, std::size_t& blocks);
  void add_columns(const Plan& plan);
  void add_targets(const Plan& plan);
  void scale(const Plan& plan);
  static void factor_diagonal(Column& column, Block& block);
  static void set_pivot(Column& column, std::size_t j, std::int64_t sum, Block& block);
  [[nodiscard]] static std::int64_t times_pivot(const Column& column, std::size_t i,
                                                std::int64_t x);
  static void scale_words(BodyVector& words, int scale, bool& fits);
  template <class Keep>
  [[nodiscard]] bool solve_down(const Plan& plan, Keep keep);
  template <class Keep>
  [[nodiscard]] bool solve_up(const Plan& plan, Keep keep);
  template <class Keep>
  [[nodiscard]] bool try_solve(const Plan& plan, std::span<BodyVector> b);

  std::vector<Column> columns_;
  std::vector<std::uint32_t> places_;  // of a body in the order
  std::vector<Below> below_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> targets_;  // blocks that each pair of blocks of a column changes
  std::vector<Set> neighbours_;         // of bodies not yet eliminated
  std::vector<Set> under_;              // by place: bodies under the diagonal
  std::vector<std::uint32_t> order_;
  std::array<std::uint32_t, k_most_bodies> degrees_{};
  std::vector<BodyVector> x_;  // by place, island by island
  std::size_t block_capacity_, target_capacity_;
  bool was_full_ = false;  // an island found no room
};

}  // namespace lockstone
