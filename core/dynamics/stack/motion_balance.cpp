#include "core/dynamics/stack/motion_balance.h"

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/fixed.h>

namespace lockstone {
namespace {

// Fraction bits of A·Aᵀ, whose entries are below 2^10, and of L, below 2^9; the least pivot: 2^-8.
// So no product leaves 64 bits.
constexpr int k_sum_bits = 22;
constexpr int k_bits = 20;
constexpr std::int64_t k_most_lower = std::int64_t{1} << (k_bits + 9);
constexpr std::int64_t k_least_sum_pivot = std::int64_t{1} << (k_sum_bits - 8);
constexpr std::int64_t k_most_solution = 4 * MotionBalance::k_most_change;

std::int64_t times_q20(std::int64_t x, std::int64_t y) {
  return raw::round_shift(x * y, k_bits);
}

std::int64_t within(std::int64_t x, std::int64_t most) {
  return std::clamp(x, -most, most);
}

}  // namespace

void MotionBalance::add(const Motion6& column) {
  LKS_ASSERT(std::ranges::all_of(
      column, [](std::int64_t x) { return std::abs(x) <= std::int64_t{1} << 27; }));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      sums_[i][j] += column[i] * column[j];
}

void MotionBalance::factor() {
  for (std::size_t j = 0; j < 6; ++j) {
    Motion6 scaled{};  // L·D, Q22
    for (std::size_t i = j; i < 6; ++i) {
      scaled[i] = raw::round_shift(sums_[i][j], 52 - k_sum_bits);
      for (std::size_t k = 0; k < j; ++k)
        scaled[i] -= times_q20(lower_[i][k], sums_[j][k]);
    }
    const std::int64_t pivot = scaled[j];
    const bool is_left_out = pivot < k_least_sum_pivot;
    over_[j] = is_left_out ? 0 : (std::int64_t{1} << (k_sum_bits + k_bits)) / pivot;
    LKS_ASSERT(over_[j] >= 0 && over_[j] <= std::int64_t{1} << (k_bits + 8));
    for (std::size_t i = j + 1; i < 6; ++i) {
      const std::int64_t part = is_left_out ? 0 : scaled[i];
      lower_[i][j] = within(times_q20(part, over_[j]) / (1 << (k_sum_bits - k_bits)), k_most_lower);
      sums_[i][j] = part;  // of a row past, from here on L·D
    }
  }
}

bool MotionBalance::solve(const Motion6& change, Motion6& x) const {
  bool fits = true;
  const auto bound = [&](std::int64_t& part) {
    const std::int64_t bounded = within(part, k_most_solution);
    fits = fits && bounded == part;
    part = bounded;
  };
  x = change;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k)
      x[i] -= times_q20(lower_[i][k], x[k]);
    bound(x[i]);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    LKS_ASSERT(over_[i] >= 0);
    x[i] = times_q20(x[i], over_[i]);
    bound(x[i]);
  }
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k)
      x[i] -= times_q20(lower_[k][i], x[k]);
    bound(x[i]);
  }
  return fits;
}

std::int64_t MotionBalance::impulse(const Motion6& column, const Motion6& solution) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 6; ++i)
    sum += column[i] * solution[i];
  return raw::round_shift(sum, 26);
}

}  // namespace lockstone
