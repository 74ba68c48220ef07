#include "core/math/exponential.h"

#include <array>
#include <bit>

#include "core/math/exponential_tables.h"
#include "core/math/factorial.h"
#include "core/math/int128.h"

namespace lockstone {
namespace {

using namespace exponential_detail;

/// e^h − 1 for h < 2^-7, both with 71 fraction bits: h + h²·(1/2! + h·(1/3! + …)).
constexpr std::uint64_t exp_minus_one(std::uint64_t h) {
  std::uint64_t p = inverse_factorial_q64(7);
  for (const int n : {6, 5, 4, 3})
    p = inverse_factorial_q64(n) + (multiply_high(h, p) >> 7);
  p = (std::uint64_t{1} << 63) + (multiply_high(h, p) >> 7);
  return h + (multiply_high(h, multiply_high(h, p)) >> 7);
}

/// 2^f for a fraction f of 64 bits, in [2^63, 2^64).
constexpr std::uint64_t power_of_fraction(std::uint64_t f) {
  const std::uint64_t start = k_power_of_two[f >> 57];
  const std::uint64_t h = multiply_high(f << 7, k_ln2_q64);  // below 2^-7, 71 fraction bits
  return start + (multiply_high(start, exp_minus_one(h)) >> 7);
}

/// ⌊a · b / 2^70⌋
constexpr std::int64_t multiply_q70(std::int64_t a, std::int64_t b) {
  return multiply_wide(a, b).high >> 6;
}

/// ln(1 + t) for |t| < 2^-7, both with 70 fraction bits: t·(1 − t·(1/2 − t·(1/3 − …))).
constexpr std::int64_t log_one_plus(std::int64_t t) {
  constexpr std::int64_t one = std::int64_t{1} << 62;
  std::int64_t p = one / 7;
  for (const int n : {6, 5, 4, 3, 2, 1})
    p = one / n - multiply_q70(t, p);
  return static_cast<std::int64_t>((multiply_wide(t, p) >> 62).low);
}

/// log2(m · 2^-63) for m ≥ 2^63, 62 fraction bits.
constexpr std::int64_t log2_of_mantissa(std::uint64_t m) {
  const auto i = static_cast<std::size_t>((m >> 56) & 127);
  const UInt128 product = multiply_wide(m, k_reciprocal[i]);  // near 1, 75 fraction bits
  const UInt128 rest = product - (UInt128{1, 0} << 11);
  const auto t = static_cast<std::int64_t>((Int128::from_bits(rest) >> 5).low);
  const std::int64_t log = multiply_wide(log_one_plus(t), k_inverse_ln2_q62).high;  // 68 bits
  return static_cast<std::int64_t>(k_logarithm[i]) + (log >> 6);
}

}  // namespace

std::uint64_t exp2_raw(std::int32_t raw, int frac_bits, int result_bits) {
  LKS_ASSERT(frac_bits >= 0 && frac_bits <= 32 && result_bits >= 0 && result_bits <= 31);
  constexpr std::uint64_t bound = std::uint64_t{1} << 31;
  const std::int64_t whole = std::int64_t{raw} >> frac_bits;
  if (whole + result_bits >= 31) return bound;
  const std::uint64_t fraction =
      frac_bits == 0 ? 0 : static_cast<std::uint64_t>(std::int64_t{raw}) << (64 - frac_bits);
  const std::int64_t drop = 63 - whole - result_bits;  // at least 33
  if (drop > 64) return 0;
  return round_shift(UInt128{0, power_of_fraction(fraction)}, static_cast<int>(drop)).low;
}

std::int64_t log2_raw(std::int64_t raw, int frac_bits, int result_bits) {
  LKS_ASSERT(raw > 0 && result_bits >= 0 && result_bits <= 56);
  const auto size = static_cast<std::uint64_t>(raw);
  const int zeros = std::countl_zero(size);
  const std::int64_t whole = 63 - zeros - frac_bits;
  const std::int64_t fraction = log2_of_mantissa(size << zeros);
  return raw::scale_binary(whole, result_bits) + raw::round_shift(fraction, 62 - result_bits);
}

}  // namespace lockstone
