// Powers of two and binary logarithms of plain numbers.
//
// Both split off the integer part and seven bits by a table, and sum a short series for the rest,
// with more than 60 good bits: the rounded result errs by little more than half a last place.
// (Tang, Table-lookup algorithms for elementary functions and their error analysis, ARITH 1991.)
#pragma once

#include <cstdint>

#include <lockstone/units.h>

namespace lockstone {

/// ⌊2^(x + result_bits)⌉ for x = raw · 2^-frac_bits, or 2^31 when that is less. 0 ≤ frac_bits ≤ 32,
/// 0 ≤ result_bits ≤ 31.
[[nodiscard]] std::uint64_t exp2_raw(std::int32_t raw, int frac_bits, int result_bits);

/// ⌊log2(raw · 2^-frac_bits) · 2^result_bits⌉ for raw > 0 and 0 ≤ result_bits ≤ 56.
[[nodiscard]] std::int64_t log2_raw(std::int64_t raw, int frac_bits, int result_bits);

/// A binary logarithm of any 32-bit format. ±32; resolution 15e-9.
using Logarithm = Fixed<Scalar, std::int32_t, 26>;

/// 2^x in the format To, or its maximum. Error < 0.5001 last places; exact at whole x that fit.
template <class To, int F>
[[nodiscard]] To exp2_saturating(Fixed<Scalar, std::int32_t, F> x) {
  const auto power = static_cast<std::int64_t>(exp2_raw(x.raw, F, To::frac_bits));
  return To::from_raw(raw::saturate<std::int32_t>(power));
}

/// 2^x in the format To; the result must be below the maximum of To.
template <class To, int F>
[[nodiscard]] To exp2(Fixed<Scalar, std::int32_t, F> x) {
  const To power = exp2_saturating<To>(x);
  LKS_ASSERT(power != To::max());
  return power;
}

/// log2 x in the format To; x > 0. Error < 0.5001 last places; exact at powers of two. A format To
/// that could not hold the logarithm of every x does not compile.
template <class To, class R, int F>
requires((std::int64_t{F} << To::frac_bits) < std::int64_t{1} << 31 &&
         (std::int64_t{sizeof(R) * 8 - 1 - F} << To::frac_bits) < std::int64_t{1} << 31)
    [[nodiscard]] To log2(Fixed<Scalar, R, F> x) {
  LKS_ASSERT(x.raw > 0);
  if (x.raw <= 0) return To::min();
  return To::from_raw(static_cast<std::int32_t>(log2_raw(x.raw, F, To::frac_bits)));
}

}  // namespace lockstone
