#include "core/dynamics/problem/body_factor.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>
#include <lockstone/fixed.h>

#include "core/math/roots.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

constexpr int k_matrix_sum_bits = 50, k_entry_bits = 30;

// The least value of a pivot, Q60: rounding may leave a pivot below its exact value.
constexpr std::int64_t k_least_factor_pivot = std::int64_t{1} << 34;

constexpr std::uint32_t k_eliminated = 0xffffffff;

// Room in the pools, for each pair of bodies that share a block, and besides: elimination fills
// blocks in, in piles about as many as there are.
constexpr std::size_t k_blocks_a_pair = 3, k_more_blocks = 256;
constexpr std::size_t k_targets_a_pair = 16, k_more_targets = 4096;

constexpr std::int64_t k_most_word = (std::int64_t{1} << 31) - 1;

std::int64_t within_word(std::int64_t x) {
  return std::clamp(x, -k_most_word, k_most_word);
}

// As `within_word`, and notes where it had to: `excess` is 0 as long as all words fit.
std::int64_t clamped(std::int64_t x, std::int64_t& excess) {
  const std::int64_t result = within_word(x);
  excess |= result ^ x;
  return result;
}

// Keeps words of a solution within their range.
struct ClampedWords {
  std::int64_t excess = 0;

  std::int64_t operator()(std::int64_t x) { return clamped(x, excess); }
  [[nodiscard]] bool fit() const { return excess == 0; }
};

// The same of words that all fit, in less time: it only looks whether they do. The outer half of
// the range counts as outside.
struct FittingWords {
  static constexpr std::int64_t k_bound = std::int64_t{1} << 30;
  std::int64_t bits = 0;

  std::int64_t operator()(std::int64_t x) {
    bits |= lanes::scalar::add(x, k_bound);
    return x;
  }
  [[nodiscard]] bool fit() const { return static_cast<std::uint64_t>(bits) < 2 * k_bound; }
};

// Wraps: words that do not fit are found out afterwards.
std::int64_t wrapped_product(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b));
}

// Times 2^bits: the scale of the rows leaves no entry above 1.
void grow(lanes::BodyBlock& block, int bits) {
  for (lanes::BlockWord& word : block.words)
    for (std::int64_t& sum : std::span(word).first<lanes::k_body_words>())
      sum = bits >= 0 ? lanes::scalar::shift_left(sum, bits) : raw::round_shift(sum, -bits);
}

}  // namespace

BodyFactor::BodyFactor(std::size_t body_capacity, std::size_t pair_capacity)
    : block_capacity_(body_capacity + k_blocks_a_pair * pair_capacity + k_more_blocks),
      target_capacity_(k_targets_a_pair * pair_capacity + k_more_targets) {
  columns_.reserve(body_capacity);
  places_.reserve(body_capacity);
  below_.reserve(block_capacity_);
  blocks_.reserve(block_capacity_);
  targets_.reserve(target_capacity_);
  neighbours_.resize(k_most_bodies);
  under_.resize(k_most_bodies);
  order_.reserve(k_most_bodies);
  x_.resize(body_capacity);
}

void BodyFactor::clear() {
  columns_.clear();
  places_.clear();
  below_.clear();
  blocks_.clear();
  targets_.clear();
  was_full_ = false;
}

// The body of least degree, the first of equals: its neighbours become neighbours of each other.
std::uint32_t BodyFactor::eliminate_next(std::uint32_t bodies) {
  LKS_ASSERT(bodies >= 1 && bodies <= k_most_bodies);
  std::uint32_t best = 0;
  for (std::uint32_t i = 1; i < bodies; ++i)
    if (degrees_[i] < degrees_[best]) best = i;
  const Set& joined = neighbours_[best];
  for (std::uint32_t i = 0; i < bodies; ++i) {
    if (!joined[i]) continue;
    neighbours_[i] |= joined;
    neighbours_[i].reset(i);
    neighbours_[i].reset(best);
    degrees_[i] = static_cast<std::uint32_t>(neighbours_[i].count());
  }
  degrees_[best] = k_eliminated;
  return best;
}

// Eliminates all bodies. Returns how many products of blocks the factor takes.
std::size_t BodyFactor::find_order(const Plan& plan, std::size_t& blocks) {
  std::size_t products = 0;
  blocks = plan.bodies;
  places_.resize(places_.size() + plan.bodies);
  order_.clear();
  for (std::uint32_t i = 0; i < plan.bodies; ++i)
    degrees_[i] = static_cast<std::uint32_t>(neighbours_[i].count());
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    const std::uint32_t body = eliminate_next(plan.bodies);
    places_[plan.first_column + body] = k;
    under_[k] = neighbours_[body];
    order_.push_back(body);
    const std::size_t count = under_[k].count();
    products += (1 + count) * (1 + count);
    blocks += count;
  }
  LKS_ASSERT(order_.size() == plan.bodies);
  return products;
}

void BodyFactor::add_columns(const Plan& plan) {
  LKS_ASSERT(order_.size() == plan.bodies);
  LKS_ASSERT(columns_.size() == plan.first_column);
  std::uint32_t block = plan.first_block + plan.bodies;
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    Column column;
    column.first = static_cast<std::uint32_t>(below_.size());
    column.body = order_[k];
    for (std::uint32_t row = k + 1; row < plan.bodies; ++row)
      if (under_[k][order_[row]]) below_.push_back({row, block++});
    column.count = static_cast<std::uint32_t>(below_.size()) - column.first;
    columns_.push_back(column);
  }
}

bool BodyFactor::plan(std::uint32_t bodies, std::span<const Pair> pairs, Plan& plan) {
  if (bodies > k_most_bodies) return false;
  was_full_ = was_full_ || columns_.size() + bodies > x_.size();
  if (columns_.size() + bodies > x_.size()) return false;
  plan = {static_cast<std::uint32_t>(columns_.size()), bodies,
          static_cast<std::uint32_t>(blocks_.size()),  0,
          static_cast<std::uint32_t>(targets_.size()), 0};
  for (std::uint32_t i = 0; i < bodies; ++i)
    neighbours_[i].reset();
  for (const auto& [a, b] : pairs) {
    LKS_ASSERT(a != b && a < bodies && b < bodies);
    neighbours_[a].set(b);
    neighbours_[b].set(a);
  }
  std::size_t blocks = 0;
  const std::size_t products = find_order(plan, blocks);
  const bool is_small = products <= k_most_products;
  const bool has_room =
      blocks_.size() + blocks <= block_capacity_ && targets_.size() + products <= target_capacity_;
  was_full_ = was_full_ || (is_small && !has_room);
  if (!is_small || !has_room) {
    places_.resize(plan.first_column);
    return false;
  }
  plan.blocks = static_cast<std::uint32_t>(blocks);
  plan.products = static_cast<std::uint32_t>(products);
  blocks_.resize(blocks_.size() + blocks);
  add_columns(plan);
  add_targets(plan);
  return true;
}

PoolUse BodyFactor::pool_use() const {
  PoolUse use;
  use.add(columns_.size(), x_.size());
  use.add(blocks_.size(), block_capacity_);
  use.add(targets_.size(), target_capacity_);
  if (was_full_) use.note_exhausted();
  return use;
}

std::uint32_t BodyFactor::find_block(const Plan& plan, std::uint32_t row,
                                     std::uint32_t column) const {
  if (row == column) return plan.first_block + row;
  const Column& c = columns_[plan.first_column + column];
  const auto all = std::span(below_).subspan(c.first, c.count);
  const auto found = std::ranges::lower_bound(all, row, {}, &Below::row);
  LKS_ASSERT(found != all.end() && found->row == row);
  return found->block;
}

// Blocks i ≥ j under the diagonal of a column change the block in row i and column j.
void BodyFactor::add_targets(const Plan& plan) {
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    const Column& c = columns_[plan.first_column + k];
    for (std::uint32_t j = c.first; j < c.first + c.count; ++j)
      for (std::uint32_t i = j; i < c.first + c.count; ++i)
        targets_.push_back(find_block(plan, below_[i].row, below_[j].row));
  }
}

BodyFactor::Place BodyFactor::find(const Plan& plan, std::uint32_t a, std::uint32_t b) const {
  LKS_ASSERT(a != b && a < plan.bodies && b < plan.bodies);
  const std::uint32_t pa = places_[plan.first_column + a], pb = places_[plan.first_column + b];
  return {find_block(plan, std::max(pa, pb), std::min(pa, pb)), pa > pb};
}

void BodyFactor::reset(const Plan& plan) {
  for (std::uint32_t i = 0; i < plan.blocks; ++i)
    blocks_[plan.first_block + i] = {};
  for (std::uint32_t k = 0; k < plan.bodies; ++k)
    for (std::size_t i = 0; i < k_side; ++i)
      blocks_[plan.first_block + k].words[i][i] = std::int64_t{1}
                                                  << (k_matrix_sum_bits - k_least_bits);
}

void BodyFactor::add(std::uint32_t block, const RowSide& x, const RowSide& y, std::int32_t k) {
  LKS_ASSERT(block < blocks_.size() && k >= 0);
  for (std::size_t j = 0; j < k_side; ++j) {
    const std::int64_t ky = raw::round_shift(std::int64_t{k} * y[j], k_entry_bits);
    for (std::size_t i = 0; i < k_side; ++i)
      blocks_[block].words[j][i] +=
          raw::round_shift(x[i] * ky, 2 * k_entry_bits - k_matrix_sum_bits);
  }
}

// The greatest diagonal entry of a body bounds its block; with another body's, the block that they
// share.
void BodyFactor::scale(const Plan& plan) {
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    std::int64_t most = 0;
    for (std::size_t i = 0; i < k_side; ++i)
      most = std::max(most, blocks_[plan.first_block + k].words[i][i]);
    LKS_ASSERT(most > 0);
    const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most)));
    columns_[plan.first_column + k].scale = (width - k_matrix_sum_bits + 1) >> 1;
  }
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    const Column& column = columns_[plan.first_column + k];
    grow(blocks_[plan.first_block + k], 60 - k_matrix_sum_bits - 2 * column.scale);
    for (std::uint32_t i = column.first; i < column.first + column.count; ++i) {
      const int other = columns_[plan.first_column + below_[i].row].scale;
      grow(blocks_[below_[i].block], 60 - k_matrix_sum_bits - column.scale - other);
    }
  }
}

std::int64_t BodyFactor::times_pivot(const Column& column, std::size_t i, std::int64_t x) {
  return raw::round_shift(x * column.mantissas[i], column.shifts[i]);
}

void BodyFactor::set_pivot(Column& column, std::size_t j, std::int64_t sum, Block& block) {
  const auto pivot = static_cast<std::uint64_t>(std::max(sum, k_least_factor_pivot));
  const auto root = static_cast<std::int64_t>(isqrt_rounded(pivot));  // 2^17 … 2^30
  const int shift = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(root)));
  column.shifts[j] = shift;
  LKS_ASSERT(root >= std::int64_t{1} << 15 && root < std::int64_t{1} << 31);
  const std::int64_t inverse = raw::round_divide(std::int64_t{1} << (k_entry_bits + shift), root);
  column.mantissas[j] = static_cast<std::int32_t>(std::min(inverse, k_most_word));
  block.words[j][j] = root;
}

// Cholesky within the block.
void BodyFactor::factor_diagonal(Column& column, Block& block) {
  for (std::size_t j = 0; j < k_side; ++j) {
    for (std::size_t i = j; i < k_side; ++i) {
      std::int64_t sum = block.words[j][i];
      for (std::size_t k = 0; k < j; ++k)
        sum -= block.words[k][i] * block.words[k][j];
      if (i == j)
        set_pivot(column, j, sum, block);
      else
        block.words[j][i] =
            within_word(times_pivot(column, j, within_word(raw::round_shift(sum, k_entry_bits))));
    }
  }
}

void BodyFactor::factor(const Plan& plan) {
  scale(plan);
  const lanes::ProximalKernels& kernels = lanes::proximal_kernels();
  const std::uint32_t* targets = targets_.data() + plan.first_target;
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    Column& column = columns_[plan.first_column + k];
    Block& diagonal = blocks_[plan.first_block + k];
    factor_diagonal(column, diagonal);
    kernels.eliminate(blocks_.data(), column, diagonal, below_.data() + column.first, targets);
    targets += std::size_t{column.count} * (column.count + 1) / 2;
    LKS_ASSERT(targets <= targets_.data() + targets_.size());
  }
}

// Times the reciprocal of pivot i.
std::int64_t divided(const lanes::FactorColumn& column, std::size_t i, std::int64_t x) {
  return lanes::scalar::round_shift(wrapped_product(x, column.mantissas[i]), column.shifts[i]);
}

template <class Keep>
bool BodyFactor::solve_down(const Plan& plan, Keep keep) {
  using lanes::scalar::round_shift, lanes::scalar::subtract;
  const lanes::ProximalKernels& kernels = lanes::proximal_kernels();
  LKS_ASSERT(plan.first_column + plan.bodies <= columns_.size());
  BodyVector* const rows = x_.data() + plan.first_column;
  bool fits = true;
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    const Column& column = columns_[plan.first_column + k];
    const Block& diagonal = blocks_[plan.first_block + k];
    BodyVector& x = rows[k];
    std::array<std::int64_t, k_side> sums{};
    for (std::size_t j = 0; j < k_side; ++j) {
      const std::int64_t rest = keep(subtract(x[j], round_shift(sums[j], k_entry_bits)));
      x[j] = keep(divided(column, j, rest));
      for (std::size_t i = j + 1; i < k_side; ++i)
        sums[i] = lanes::scalar::add(sums[i], wrapped_product(diagonal.words[j][i], x[j]));
    }
    if (column.count == 0) continue;
    fits =
        kernels.solve_down(blocks_.data(), column, below_.data() + column.first, x, rows) && fits;
  }
  return fits && keep.fit();
}

template <class Keep>
bool BodyFactor::solve_up(const Plan& plan, Keep keep) {
  using lanes::scalar::round_shift, lanes::scalar::subtract;
  const lanes::ProximalKernels& kernels = lanes::proximal_kernels();
  LKS_ASSERT(plan.first_column + plan.bodies <= columns_.size());
  BodyVector* const rows = x_.data() + plan.first_column;
  for (std::uint32_t k = plan.bodies; k-- > 0;) {
    const Column& column = columns_[plan.first_column + k];
    const Block& diagonal = blocks_[plan.first_block + k];
    BodyVector& x = rows[k];
    BodyVector sums{};
    if (column.count != 0)
      kernels.solve_up(blocks_.data(), column, below_.data() + column.first, rows, sums);
    for (std::size_t i = k_side; i-- > 0;) {
      std::int64_t sum = 0;
      for (std::size_t j = i + 1; j < k_side; ++j)
        sum = lanes::scalar::add(sum, wrapped_product(diagonal.words[i][j], x[j]));
      const std::int64_t rest = subtract(subtract(x[i], sums[i]), round_shift(sum, k_entry_bits));
      x[i] = keep(divided(column, i, keep(rest)));
    }
  }
  return keep.fit();
}

// Scales the words of a body by 2^-scale. Words that fit afterwards need no clamp.
void BodyFactor::scale_words(BodyVector& words, int scale, bool& fits) {
  LKS_ASSERT(scale > -62 && scale <= 62);
  const std::int64_t bound = FittingWords::k_bound >> std::max(-scale, 0);
  std::int64_t bits = 0;
  for (std::size_t i = 0; i < k_side; ++i)
    bits |= lanes::scalar::add(words[i], bound);
  if (static_cast<std::uint64_t>(bits) < static_cast<std::uint64_t>(2 * bound)) {
    for (std::int64_t& word : std::span(words).first<k_side>())
      word = scale <= 0 ? word * (std::int64_t{1} << -scale) : raw::round_shift(word, scale);
    return;
  }
  std::int64_t excess = 0;
  for (std::size_t i = 0; i < k_side; ++i)
    words[i] = clamped(raw::scale_saturating(words[i], -scale), excess);
  fits = fits && excess == 0;
}

template <class Keep>
bool BodyFactor::try_solve(const Plan& plan, std::span<BodyVector> b) {
  LKS_ASSERT(plan.first_column + plan.bodies <= columns_.size());
  bool fits = true;
  BodyVector* const rows = x_.data() + plan.first_column;
  const Column* const columns = columns_.data() + plan.first_column;
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    LKS_ASSERT(columns[k].body < b.size());
    rows[k] = b[columns[k].body];
    scale_words(rows[k], columns[k].scale, fits);
  }
  fits = solve_down(plan, Keep()) && fits;
  return solve_up(plan, Keep()) && fits;
}

bool BodyFactor::solve(const Plan& plan, std::span<BodyVector> b) {
  LKS_ASSERT(b.size() == plan.bodies);
  bool fits = try_solve<FittingWords>(plan, b) || try_solve<ClampedWords>(plan, b);
  const BodyVector* const rows = x_.data() + plan.first_column;
  const Column* const columns = columns_.data() + plan.first_column;
  for (std::uint32_t k = 0; k < plan.bodies; ++k) {
    BodyVector& x = b[columns[k].body];
    x = rows[k];
    scale_words(x, columns[k].scale, fits);
  }
  return fits;
}

}  // namespace lockstone
