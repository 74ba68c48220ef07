// The kernels of proximal_block.h for the target at hand: the matrix and its factor.
#if defined(LKS_WIDE_PROXIMAL_MATRIX_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_PROXIMAL_MATRIX_INL_H
#undef LKS_WIDE_PROXIMAL_MATRIX_INL_H
#else
#define LKS_WIDE_PROXIMAL_MATRIX_INL_H
#endif

#include <bit>

#include "core/kernels/proximal/proximal_inl.h"
#include "core/math/wide/scalar_lanes.h"

// As in proximal_inl.h.
#if defined(LKS_SCALAR_TWIN) || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_NEON || \
    HWY_TARGET == HWY_WASM
HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

HWY_ATTR void couple(ProximalBlock& block) {
  for (std::size_t r = 0; r < block.rows; ++r) {
    BlockWord a = block.by_row[r], b;
    for (std::size_t i = 0; i < k_block_lanes; ++i)
      b[i] = scalar::high(a[i]);
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes)
      store(round_shift<30>(row_dots(block, lane, a, b)), &block.coupling[r][lane]);
    const std::int64_t own = block.coupling[r][r] + block.give[r];
    block.coupling[r][r] = own < INT32_MAX ? own : INT32_MAX;
  }
}

/// The active rows of one body, and the same times their weights, Q30.
struct WeightedRows {
  BlockWord rows[k_most_rows];
  BlockWord weighted[k_most_rows];
  std::size_t count = 0;

  HWY_INLINE HWY_ATTR void add_row(Lanes row, Lanes weight, std::size_t lane) {
    store(row, &rows[count][lane]);
    store(round_shift_low<30>(multiply(row, weight)), &weighted[count][lane]);
  }
};

/// Adds the products of rows, of the body whose rows are lanes, and weighted ones, of the body
/// whose columns are words. At most seven: sums of products stay below 2^63.
HWY_INLINE HWY_ATTR void add_products(const BlockWord* rows, const BlockWord* columns,
                                      std::size_t count, BodyBlock& block) {
  constexpr std::size_t k_parts = k_block_lanes / k_lanes;
  for (std::size_t k = 0; k < k_body_words; ++k) {
    Lanes sums[k_parts];
    for (Lanes& sum : sums)
      sum = broadcast(0);
    for (std::size_t r = 0; r < count; ++r) {
      const Lanes by = broadcast(columns[r][k]);
      for (std::size_t part = 0; part < k_parts; ++part)
        sums[part] = multiply_add(sums[part], load(&rows[r][part * k_lanes]), by);
    }
    for (std::size_t part = 0; part < k_parts; ++part) {
      std::int64_t* to = &block.words[k][part * k_lanes];
      store(add(load(to), round_shift<10>(sums[part])), to);
    }
  }
}

HWY_ATTR void add_to_matrix(const ProximalBlock& block, const MatrixPlaces& places) {
  WeightedRows of_a, of_b;
  for (std::size_t r = 0; r < block.rows; ++r) {
    if (block.active[r] == 0) continue;
    const Lanes weight = broadcast(block.weight[r]);
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes row = load(&block.by_row[r][lane]);
      of_a.add_row(row, weight, lane);
      of_b.add_row(upper(row), weight, lane);
    }
    ++of_a.count;
    ++of_b.count;
  }
  if (of_a.count == 0) return;
  const std::size_t count = of_a.count;
  if (places.a != nullptr) add_products(of_a.rows, of_a.weighted, count, *places.a);
  if (places.b != nullptr) add_products(of_b.rows, of_b.weighted, count, *places.b);
  if (places.both == nullptr) return;
  const WeightedRows &rows = places.a_is_row ? of_a : of_b,
                     &columns = places.a_is_row ? of_b : of_a;
  add_products(rows.rows, columns.weighted, count, *places.both);
}

/// Words behind the components.
HWY_INLINE HWY_ATTR void clear_rest(BlockWord& words) {
  words[k_body_words] = words[k_body_words + 1] = 0;
}

HWY_ATTR void add_rows(const BlockWord* rows, std::uint32_t used, const MatrixPlaces& places) {
  BlockWord a[k_most_rows], b[k_most_rows];
  while (used != 0) {
    std::size_t count = 0;
    for (; used != 0 && count < k_most_rows; used &= used - 1, ++count) {
      const BlockWord& row = rows[std::countr_zero(used)];
      for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
        const Lanes both = load(&row[lane]);
        store(both, &a[count][lane]);
        store(upper(both), &b[count][lane]);
      }
      clear_rest(a[count]);
      clear_rest(b[count]);
    }
    if (places.a != nullptr) add_products(a, a, count, *places.a);
    if (places.b != nullptr) add_products(b, b, count, *places.b);
    if (places.both == nullptr) continue;
    add_products(places.a_is_row ? a : b, places.a_is_row ? b : a, count, *places.both);
  }
}

HWY_ATTR void subtract_rows(const BlockWord* rows, std::uint32_t used, const std::int64_t* x,
                            BlockWord& a, BlockWord& b) {
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    Lanes of_a = broadcast(0), of_b = broadcast(0);
    for (std::uint32_t left = used; left != 0; left &= left - 1) {
      const auto r = static_cast<std::size_t>(std::countr_zero(left));
      const Lanes row = load(&rows[r][lane]), by = broadcast(x[r]);
      of_a = multiply_subtract(of_a, row, by);
      of_b = multiply_subtract(of_b, upper(row), by);
    }
    store(add(load(&a[lane]), round_shift<30>(of_a)), &a[lane]);
    store(add(load(&b[lane]), round_shift<30>(of_b)), &b[lane]);
  }
  clear_rest(a);
  clear_rest(b);
}

HWY_ATTR void row_products(const BlockWord* rows, std::uint32_t used, const BlockWord& a,
                           const BlockWord& b, std::int64_t* products) {
  for (; used != 0; used &= used - 1) {
    const auto r = static_cast<std::size_t>(std::countr_zero(used));
    Lanes sum = broadcast(0);
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      const Lanes row = load(&rows[r][lane]);
      sum = multiply_add(sum, row, load(&a[lane]));
      sum = multiply_add(sum, upper(row), load(&b[lane]));
    }
    products[r] = sum_of(sum);
  }
}

/// X·Gᵀ = sums, G the factor of the diagonal, row by row in lanes.
HWY_INLINE HWY_ATTR void divide_by(const BodyBlock& diagonal, const FactorColumn& column,
                                   BodyBlock& block) {
  for (std::size_t j = 0; j < k_body_words; ++j) {
    const Shift by_pivot(column.shifts[j]);
    const Lanes mantissa = broadcast(column.mantissas[j]);
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      Lanes sum = load(&block.words[j][lane]);
      for (std::size_t k = 0; k < j; ++k)
        sum = multiply_subtract(sum, load(&block.words[k][lane]), broadcast(diagonal.words[k][j]));
      const Lanes entry = within(round_shift<30>(sum), INT32_MAX);
      store(within(by_pivot(multiply(entry, mantissa)), INT32_MAX), &block.words[j][lane]);
    }
  }
  for (std::size_t k = 0; k < k_body_words; ++k) {
    block.words[k][k] = scalar::pack(block.words[k][k], block.words[k][k]);
    for (std::size_t i = 0; i < k; ++i) {
      const std::int64_t x = block.words[k][i], y = block.words[i][k];
      block.words[k][i] = scalar::pack(x, y);
      block.words[i][k] = scalar::pack(y, x);
    }
  }
}

HWY_INLINE HWY_ATTR void subtract_product(const BodyBlock& x, const BodyBlock& y, BodyBlock& from) {
  for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
    Lanes rows[k_body_words];
    for (std::size_t k = 0; k < k_body_words; ++k)
      rows[k] = load(&x.words[k][lane]);
    for (std::size_t j = 0; j < k_body_words; ++j) {
      Lanes sum = load(&from.words[j][lane]);
      for (std::size_t k = 0; k < k_body_words; ++k)
        sum = multiply_subtract(sum, rows[k], broadcast(y.words[k][j]));
      store(sum, &from.words[j][lane]);
    }
  }
}

HWY_ATTR void eliminate(BodyBlock* blocks, const FactorColumn& column, const BodyBlock& diagonal,
                        const BelowDiagonal* below, const std::uint32_t* targets) {
  for (std::uint32_t i = 0; i < column.count; ++i)
    divide_by(diagonal, column, blocks[below[i].block]);
  for (std::uint32_t j = 0; j < column.count; ++j)
    for (std::uint32_t i = j; i < column.count; ++i)
      subtract_product(blocks[below[i].block], blocks[below[j].block], blocks[*targets++]);
}

HWY_ATTR bool solve_down(const BodyBlock* blocks, const FactorColumn& column,
                         const BelowDiagonal* below, const BlockWord& x, BlockWord* rows) {
  Lanes off = broadcast(0);
  for (std::uint32_t n = 0; n < column.count; ++n) {
    const BodyBlock& block = blocks[below[n].block];
    BlockWord& y = rows[below[n].row];
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      Lanes sum = broadcast(0);
      for (std::size_t j = 0; j < k_body_words; ++j)
        sum = multiply_add(sum, load(&block.words[j][lane]), broadcast(x[j]));
      const Lanes rest = subtract(load(&y[lane]), round_shift<30>(sum));
      const Lanes kept = within(rest, INT32_MAX);
      off = bit_or(off, subtract(rest, kept));
      store(kept, &y[lane]);
    }
  }
  return all_bits(off) == 0;
}

HWY_ATTR void solve_up(const BodyBlock* blocks, const FactorColumn& column,
                       const BelowDiagonal* below, const BlockWord* rows, BlockWord& sums) {
  for (std::uint32_t n = 0; n < column.count; ++n) {
    const BodyBlock& block = blocks[below[n].block];
    const BlockWord& y = rows[below[n].row];
    for (std::size_t lane = 0; lane < k_block_lanes; lane += k_lanes) {
      Lanes sum = broadcast(0);
      for (std::size_t i = 0; i < k_body_words; ++i)
        sum = multiply_add(sum, upper(load(&block.words[i][lane])), broadcast(y[i]));
      store(add(load(&sums[lane]), round_shift<30>(sum)), &sums[lane]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();
#endif  // the targets

#endif  // the guard
