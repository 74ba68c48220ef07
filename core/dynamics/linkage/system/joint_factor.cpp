#include "core/dynamics/linkage/system/joint_factor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <type_traits>

#include <lockstone/assert.h>

#include "core/math/int128.h"
#include "core/math/product_sum.h"
#include "core/math/reciprocal.h"

namespace lockstone {
namespace {

// Room for joints of six rows with four neighbours each, or of three with sixteen.
constexpr std::size_t k_values_per_joint = 152;
constexpr std::size_t k_blocks_per_joint = 8;

// A group may have this many blocks a joint: trees and small loops do.
constexpr std::size_t k_most_blocks_per_joint = 6;

constexpr std::int64_t k_least_pivot = std::int64_t{1} << (k_matrix_bits - 24);

// A solution of 2^10 has impulses that light bodies should not get at once, see `TreeLocks`.
constexpr std::uint64_t k_solution_bound = std::uint64_t{1} << 56;

// Bits that a solution loses where it would not fit, and how often.
constexpr int k_lost_bits = 12, k_most_tries = 4;

// x ← x − part, clamped, since the factors of a matrix that is nearly singular have no bound.
// Returns whether it fits.
bool take(std::int64_t& x, std::int64_t part) {
  const std::int64_t left = x - part;
  x = std::clamp(left, -k_product_bound, k_product_bound);
  return x == left && magnitude(part) < k_product_bound;
}

// Points have three rows, contacts four, hinges five: numbers that are known while compiling.
using Three = std::integral_constant<std::uint32_t, 3>;
using Four = std::integral_constant<std::uint32_t, 4>;
using Five = std::integral_constant<std::uint32_t, 5>;

template <class Task>
void with_size(std::uint32_t n, const Task& task) {
  if (n == 3) return task(Three{});
  if (n == 4) return task(Four{});
  if (n == 5) return task(Five{});
  task(n);
}

template <class Rows, class Columns, class Terms>
struct Product {
  Rows rows;
  Columns columns;
  Terms terms;
  bool is_lower;  // only entries on and below the diagonal
};

// Clang 14 finds none for an aggregate by itself.
template <class Rows, class Columns, class Terms>
Product(Rows, Columns, Terms, bool) -> Product<Rows, Columns, Terms>;

// to ← to − entries·factorsᵀ
template <class Rows, class Columns, class Terms>
void subtract_product(std::int64_t* to, const Product<Rows, Columns, Terms>& size,
                      const std::int64_t* entries, const std::int64_t* factors) {
  for (std::uint32_t r = 0; r < size.rows; ++r) {
    const std::uint32_t end = size.is_lower ? r + 1 : size.columns;
    for (std::uint32_t s = 0; s < end; ++s) {
      ProductSum sum;
      for (std::uint32_t c = 0; c < size.terms; ++c)
        sum.add(entries[r * size.terms + c], factors[s * size.terms + c]);
      (void)take(to[r * size.columns + s], sum.rounded(k_factor_bits));
    }
  }
}

template <class Terms>
ProductSum dot_product(const std::int64_t* x, const std::int64_t* y, Terms terms) {
  ProductSum sum;
  for (std::uint32_t c = 0; c < terms; ++c)
    sum.add(x[c], y[c]);
  return sum;
}

}  // namespace

JointFactor::JointFactor(std::size_t joint_capacity)
    : value_capacity_(joint_capacity * k_values_per_joint),
      block_capacity_(joint_capacity * k_blocks_per_joint) {
  columns_.reserve(joint_capacity);
  blocks_.reserve(block_capacity_);
  values_.reserve(value_capacity_);
  rhs_.reserve(joint_capacity * k_factor_rows);
  given_.reserve(joint_capacity * k_factor_rows);
  reciprocals_.reserve(joint_capacity * k_factor_rows);
  marks_.reserve(joint_capacity);
  found_.reserve(joint_capacity);
  head_.reserve(joint_capacity);
  next_.reserve(joint_capacity);
}

void JointFactor::clear() {
  columns_.clear();
  blocks_.clear();
  values_.clear();
  rhs_.clear();
  given_.clear();
  reciprocals_.clear();
  was_full_ = false;
}

PoolUse JointFactor::pool_use() const {
  PoolUse use;
  use.add(blocks_.size(), block_capacity_);
  use.add(values_.size(), value_capacity_);
  if (was_full_) use.note_exhausted();
  return use;
}

// The column of joint k from `found_`.
bool JointFactor::plan_column(std::uint32_t k, std::uint32_t count, std::uint32_t rows,
                              std::size_t most_rows) {
  LKS_ASSERT(rows <= most_rows && most_rows <= k_factor_rows);
  std::sort(found_.begin(), found_.end());
  LKS_ASSERT(found_.empty() || (found_.front() > k && found_.back() < count));
  Column column;
  column.rows = rows;
  column.first_block = static_cast<std::uint32_t>(blocks_.size());
  column.block_count = static_cast<std::uint32_t>(found_.size());
  column.diagonal = static_cast<std::uint32_t>(values_.size());
  column.first_row = static_cast<std::uint32_t>(rhs_.size());
  std::size_t values = values_.size() + std::size_t{rows} * rows;
  const std::size_t group_blocks = blocks_.size() - first_block_;
  if (group_blocks + found_.size() > k_most_blocks_per_joint * count + 64) return false;
  if (blocks_.size() + found_.size() > block_capacity_) {
    was_full_ = true;
    return false;
  }
  for (const std::uint32_t row : found_) {
    blocks_.push_back({row, static_cast<std::uint32_t>(values)});
    values += most_rows * rows;
  }
  if (values > value_capacity_) {
    was_full_ = true;
    return false;
  }
  values_.resize(values);
  rhs_.resize(rhs_.size() + rows);
  given_.resize(rhs_.size());
  reciprocals_.resize(rhs_.size());
  if (!found_.empty()) {
    next_[k] = head_[found_.front()];
    head_[found_.front()] = k + 1;
  }
  columns_.push_back(column);
  return true;
}

std::int64_t* JointFactor::find_block(const Column& column, std::uint32_t row) {
  const auto all = blocks(column);
  const auto found = std::ranges::lower_bound(all, row, {}, &Block::row);
  LKS_ASSERT(found != all.end() && found->row == row);  // planned
  return values_.data() + found->values;
}

// A pivot d in Q56 has the reciprocal m·2^-shift with m of 62 bits.
std::uint32_t JointFactor::factor_diagonal(Column& column) {
  std::int64_t* d = values_.data() + column.diagonal;
  const std::uint32_t n = column.count;
  LKS_ASSERT(n <= column.rows);
  std::uint32_t left_out = 0;
  for (std::uint32_t c = 0; c < n; ++c) {
    const std::int64_t pivot = d[c * n + c];
    LKS_ASSERT(pivot <= std::int64_t{1} << k_matrix_bits);
    Reciprocal& inverse = reciprocals_[column.first_row + c];
    if (pivot < k_least_pivot) {
      inverse = {};
      ++left_out;
    } else {
      const int zeros = std::countl_zero(static_cast<std::uint64_t>(pivot));
      const std::uint64_t mantissa = reciprocal_q124(static_cast<std::uint64_t>(pivot) << zeros);
      inverse = {static_cast<std::int64_t>(mantissa), 60 + 64 - zeros - k_matrix_bits};
    }
    std::array<std::int64_t, k_factor_rows> above{};
    for (std::uint32_t r = c + 1; r < n; ++r) {
      above[r] = d[r * n + c];
      d[r * n + c] = inverse.mantissa == 0
                         ? 0
                         : product_rounded(above[r], inverse.mantissa,
                                           inverse.shift + k_matrix_bits - k_factor_bits);
    }
    for (std::uint32_t r = c + 1; r < n; ++r) {
      for (std::uint32_t s = c + 1; s <= r; ++s)
        (void)take(d[r * n + s], product_rounded(d[r * n + c], above[s], k_factor_bits));
    }
  }
  return left_out;
}

// B ← B·L⁻ᵀ
template <class Size>
void JointFactor::eliminate_block(const Column& column, std::int64_t* b, std::uint32_t rows,
                                  Size n) const {
  const std::int64_t* d = values_.data() + column.diagonal;
  for (std::uint32_t r = 0; r < rows; ++r) {
    std::int64_t* line = b + r * n;
    for (std::uint32_t c = 1; c < n; ++c) {
      ProductSum sum;
      for (std::uint32_t s = 0; s < c; ++s)
        sum.add(line[s], d[c * n + s]);
      (void)take(line[c], sum.rounded(k_factor_bits));
    }
  }
}

// The blocks below.
void JointFactor::eliminate(std::uint32_t first, const Column& column) {
  for (const Block& block : blocks(column)) {
    std::int64_t* b = values_.data() + block.values;
    const std::uint32_t rows = columns_[first + block.row].count;
    with_size(column.count, [&](auto n) { eliminate_block(column, b, rows, n); });
  }
}

// In place: from entries to factors, b ← b·D⁻¹. Keeps the entries.
template <class Size>
void JointFactor::divide_rows(const Column& column, std::int64_t* b, std::uint32_t rows, Size n,
                              Entries& entries) const {
  for (std::uint32_t c = 0; c < n; ++c) {
    const Reciprocal& inverse = reciprocals_[column.first_row + c];
    LKS_ASSERT(inverse.mantissa >= 0);
    const int shift = inverse.shift + k_matrix_bits - k_factor_bits;
    for (std::uint32_t at = c; at < rows * n; at += n) {
      entries[at] = b[at];
      b[at] = inverse.mantissa == 0 ? 0 : product_rounded(b[at], inverse.mantissa, shift);
    }
  }
}

// A_ij ← A_ij − B_i·D⁻¹·B_jᵀ for all pairs of blocks below, then B ← B·D⁻¹.
void JointFactor::update(std::uint32_t first, const Column& column) {
  const std::uint32_t n = column.count;
  LKS_ASSERT(n <= column.rows);
  const std::span<const Block> below = blocks(column);
  Entries entries;
  for (std::size_t j = 0; j < below.size(); ++j) {
    const Column& target = columns_[first + below[j].row];
    std::int64_t* const b = values_.data() + below[j].values;
    with_size(n, [&](auto size) { divide_rows(column, b, target.count, size, entries); });
    for (std::size_t i = 0; i <= j; ++i) {
      // Block (j, i) stands in the column of i; the blocks up to j hold factors already.
      const Column& column_i = columns_[first + below[i].row];
      std::int64_t* to =
          i == j ? values_.data() + target.diagonal : find_block(column_i, below[j].row);
      const std::int64_t* factors = values_.data() + below[i].values;
      const auto subtract = [&](auto rows, auto columns, auto terms) {
        subtract_product(to, Product{rows, columns, terms, i == j}, entries.data(), factors);
      };
      const bool alike = n == target.count && n == column_i.count;
      if (alike && n == 3)
        subtract(Three{}, Three{}, Three{});
      else if (alike && n == 4)
        subtract(Four{}, Four{}, Four{});
      else
        with_size(n, [&](auto terms) { subtract(target.count, column_i.count, terms); });
    }
  }
}

std::uint32_t JointFactor::factor(std::uint32_t first, std::uint32_t count) {
  std::uint32_t left_out = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    Column& column = columns_[first + k];
    LKS_ASSERT(column.count <= k_factor_rows);
    left_out += factor_diagonal(column);
    eliminate(first, column);
    update(first, column);
  }
  return left_out;
}

int JointFactor::solve(std::uint32_t first, std::uint32_t count) {
  LKS_ASSERT(count > 0 && first + count <= columns_.size());
  const Column& last = columns_[first + count - 1];
  const std::size_t begin = columns_[first].first_row, size = last.first_row + last.rows - begin;
  const std::span<std::int64_t> rhs = std::span(rhs_).subspan(begin, size);
  const std::span<std::int64_t> given = std::span(given_).subspan(begin, size);
  std::copy(rhs.begin(), rhs.end(), given.begin());
  int lost = 0;
  for (int i = 1; !try_solve(first, count) && i < k_most_tries; ++i) {
    lost += k_lost_bits;
    for (std::size_t k = 0; k < size; ++k)
      rhs[k] = raw::round_shift(given[k], lost);
  }
  LKS_ASSERT(lost < k_lost_bits * k_most_tries);
  return lost;
}

// Returns whether the solution fits.
bool JointFactor::try_solve(std::uint32_t first, std::uint32_t count) {
  LKS_ASSERT(std::ranges::all_of(columns(first, count),
                                 [](const Column& column) { return column.count <= column.rows; }));
  bool fits = true;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Column& column = columns_[first + k];
    with_size(column.count, [&](auto n) { fits = substitute(first, column, n) && fits; });
  }
  for (std::uint32_t k = count; k-- > 0;) {
    const Column& column = columns_[first + k];
    with_size(column.count, [&](auto n) { fits = substitute_back(first, column, n) && fits; });
  }
  return fits;
}

// Forward substitution: subtracts the terms of one joint's rows from its own and from those below.
// Both return whether all numbers fit.
template <class Size>
bool JointFactor::substitute(std::uint32_t first, const Column& column, Size n) {
  LKS_ASSERT(n <= k_factor_rows);
  std::int64_t* y = rhs_.data() + column.first_row;
  const std::int64_t* d = values_.data() + column.diagonal;
  bool fits = true;
  for (std::uint32_t r = 1; r < n; ++r)
    fits = take(y[r], dot_product(d + r * n, y, r).rounded(k_factor_bits)) && fits;
  for (const Block& block : blocks(column)) {
    const Column& target = columns_[first + block.row];
    const std::int64_t* line = values_.data() + block.values;
    std::int64_t* x = rhs_.data() + target.first_row;
    for (std::uint32_t r = 0; r < target.count; ++r, line += n)
      fits = take(x[r], dot_product(line, y, n).rounded(k_factor_bits)) && fits;
  }
  return fits;
}

template <class Size>
bool JointFactor::substitute_back(std::uint32_t first, const Column& column, Size n) {
  LKS_ASSERT(n <= k_factor_rows);
  std::int64_t* y = rhs_.data() + column.first_row;
  const std::int64_t* d = values_.data() + column.diagonal;
  std::array<ProductSum, k_factor_rows> sums;
  for (const Block& block : blocks(column)) {
    const Column& target = columns_[first + block.row];
    const std::int64_t* line = values_.data() + block.values;
    const std::int64_t* x = rhs_.data() + target.first_row;
    for (std::uint32_t r = 0; r < target.count; ++r, line += n) {
      for (std::uint32_t c = 0; c < n; ++c)
        sums[c].add(line[c], x[r]);
    }
  }
  bool fits = true;
  for (std::uint32_t c = n; c-- > 0;) {
    const Reciprocal& inverse = reciprocals_[column.first_row + c];
    if (inverse.mantissa == 0) {
      y[c] = 0;
      continue;
    }
    for (std::uint32_t r = c + 1; r < n; ++r)
      sums[c].add(d[r * n + c], y[r]);
    y[c] = product_rounded(y[c], inverse.mantissa, inverse.shift);
    fits = magnitude(y[c]) < k_product_bound && fits;
    fits = take(y[c], sums[c].rounded(k_factor_bits)) && fits;
    fits = magnitude(y[c]) < k_solution_bound && fits;
  }
  return fits;
}

}  // namespace lockstone
