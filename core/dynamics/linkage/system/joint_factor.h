// Block-sparse LDLᵀ of the rows of joints that are solved together.
//
// The plan (which blocks there are) follows from which joints share a pushed body; values follow in
// every substep. Entries are scaled by powers of two of their rows, so that the diagonal lies in
// (2^-4, 1] and no entry exceeds 1; they have 56 fraction bits, factors 40. A row whose pivot is
// below 2^-24 counts as linearly dependent on others: it is left out, and counted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

#include "core/base/pool_use.h"
#include "core/dynamics/state/joint_record.h"

namespace lockstone {

inline constexpr int k_matrix_bits = 56;
inline constexpr int k_factor_bits = 40;

/// Most rows of a column: the locks of a joint.
inline constexpr std::size_t k_factor_rows = k_joint_axes;

class JointFactor {
 public:
  /// A block of the most rows and columns there are.
  using Entries = std::array<std::int64_t, k_factor_rows * k_factor_rows>;

  /// No function but this allocates.
  [[gnu::cold]] explicit JointFactor(std::size_t joint_capacity);

  void clear();

  /// Plans the columns of `count` joints in the order of elimination. `neighbours(k, emit)` calls
  /// emit(i) for each later joint i that shares a pushed body with k; `rows(k)` is the most rows
  /// that joint k can have, of the group at most `most_rows`. False when the pools are full or it
  /// would fill in too much; then nothing has been planned.
  template <class Neighbours, class Rows>
  bool plan(std::uint32_t count, const Neighbours& neighbours, const Rows& rows,
            std::size_t most_rows = k_joint_axes);

  /// Of all groups planned since `clear`.
  [[nodiscard]] PoolUse pool_use() const;

  /// Where the group planned last begins; its columns follow one another.
  [[nodiscard]] std::uint32_t first() const { return first_; }

  struct Block {
    std::uint32_t row = 0;     // joint within the group
    std::uint32_t values = 0;  // of its first entry: rows of `row`, by columns of the joint
  };
  struct Column {
    std::uint32_t first_block = 0;
    std::uint32_t block_count = 0;  // below the diagonal
    std::uint32_t diagonal = 0;     // of its first entry
    std::uint32_t rows = 0;         // the most there can be
    std::uint32_t count = 0;        // rows now
    std::uint32_t first_row = 0;    // of its reciprocals and right-hand side
  };
  [[nodiscard]] std::span<Column> columns(std::uint32_t first, std::uint32_t count) {
    return std::span(columns_).subspan(first, count);
  }
  [[nodiscard]] std::span<const Block> blocks(const Column& column) const {
    return std::span(blocks_).subspan(column.first_block, column.block_count);
  }
  [[nodiscard]] std::int64_t& value(std::uint32_t at) { return values_[at]; }

  /// Right-hand side, then solution: 46 fraction bits.
  [[nodiscard]] std::int64_t& rhs(std::uint32_t row) { return rhs_[row]; }
  [[nodiscard]] std::span<std::int64_t> rhs_of(const Column& column) {
    return std::span(rhs_).subspan(column.first_row, column.rows);
  }

  /// Sets all entries of the group by its columns' counts: block(j, k, to) writes the responses of
  /// the rows of joint j to impulses on those of joint k, row by row, for j = k (as far as the
  /// diagonal) and below.
  template <class Fill>
  void fill_blocks(std::uint32_t first, std::uint32_t count, const Fill& block);

  /// Factors the group in place. Returns the number of pivots that were left out.
  std::uint32_t factor(std::uint32_t first, std::uint32_t count);

  /// Solves for `rhs`. Returns by how many fraction bits the solution is shorter than 46: almost
  /// always none, more where it would exceed 2^10.
  [[nodiscard]] int solve(std::uint32_t first, std::uint32_t count);

 private:
  struct Reciprocal {
    std::int64_t mantissa = 0;
    int shift = 0;  // of a product with an entry, to give one with as many bits
  };
  bool plan_column(std::uint32_t k, std::uint32_t count, std::uint32_t rows, std::size_t most_rows);
  std::uint32_t factor_diagonal(Column& column);
  void eliminate(std::uint32_t first, const Column& column);
  template <class Size>
  void eliminate_block(const Column& column, std::int64_t* b, std::uint32_t rows, Size n) const;
  template <class Size>
  void divide_rows(const Column& column, std::int64_t* b, std::uint32_t rows, Size n,
                   Entries& entries) const;
  void update(std::uint32_t first, const Column& column);
  [[nodiscard]] bool try_solve(std::uint32_t first, std::uint32_t count);
  template <class Size>
  [[nodiscard]] bool substitute(std::uint32_t first, const Column& column, Size n);
  template <class Size>
  [[nodiscard]] bool substitute_back(std::uint32_t first, const Column& column, Size n);
  [[nodiscard]] std::int64_t* find_block(const Column& column, std::uint32_t row);

  std::vector<Column> columns_;
  std::vector<Block> blocks_;
  std::vector<std::int64_t> values_;
  std::vector<std::int64_t> rhs_;
  std::vector<std::int64_t> given_;  // the right-hand side, for another try
  std::vector<Reciprocal> reciprocals_;
  std::vector<std::uint32_t> marks_;  // by joint of a group: the column it was last seen in, + 1
  std::vector<std::uint32_t> found_;
  std::vector<std::uint32_t> head_, next_;  // children by parent in the elimination tree
  std::uint32_t first_ = 0;
  std::size_t first_block_ = 0;  // of the group being planned
  std::size_t value_capacity_, block_capacity_;
  bool was_full_ = false;  // a group found no room
};

template <class Fill>
void JointFactor::fill_blocks(std::uint32_t first, std::uint32_t count, const Fill& block) {
  const std::span<const Column> group = columns(first, count);
  for (std::uint32_t k = 0; k < count; ++k) {
    block(k, k, values_.data() + group[k].diagonal);
    for (const Block& below : blocks(group[k])) {
      LKS_ASSERT(below.row > k && below.row < count);
      block(below.row, k, values_.data() + below.values);
    }
  }
}

template <class Neighbours, class Rows>
bool JointFactor::plan(std::uint32_t count, const Neighbours& neighbours, const Rows& rows,
                       std::size_t most_rows) {
  first_ = static_cast<std::uint32_t>(columns_.size());
  first_block_ = blocks_.size();
  const std::size_t blocks = blocks_.size(), values = values_.size(), sides = rhs_.size();
  marks_.assign(count, 0);
  head_.assign(count, 0);
  next_.assign(count, 0);
  bool fits = true;
  for (std::uint32_t k = 0; k < count && fits; ++k) {
    found_.clear();
    const auto emit = [&](std::uint32_t i) {
      if (i <= k || marks_[i] == k + 1) return;
      marks_[i] = k + 1;
      found_.push_back(i);
    };
    neighbours(k, emit);
    for (std::uint32_t child = head_[k]; child != 0; child = next_[child - 1]) {
      for (const Block& block : this->blocks(columns_[first_ + child - 1]))
        emit(block.row);
    }
    fits = plan_column(k, count, rows(k), most_rows);
  }
  LKS_ASSERT(columns_.size() - first_ <= count);
  if (fits) return true;
  columns_.resize(first_);
  blocks_.resize(blocks);
  values_.resize(values);
  rhs_.resize(sides);
  given_.resize(sides);
  reciprocals_.resize(sides);
  return false;
}

}  // namespace lockstone
