#include <lockstone/decimal.h>

#include "core/math/block_float.h"
#include "core/math/divide.h"
#include "core/math/exponential.h"
#include "tools/numerics/vector_parts.h"

namespace lockstone::numerics {
namespace {

constexpr Domain k_shift{0, 62};
constexpr Domain k_mantissa{0, k_max32};
constexpr Domain k_exponent{-40, 40};

BlockFloat block_at(const Words& in, std::size_t at) {
  return {i32(in[at]), static_cast<std::int8_t>(in[at + 1])};
}

Words words(BlockFloat x) {
  return {x.mantissa, x.exponent};
}

Words words(UInt128 x) {
  return {i64(x.high), i64(x.low)};
}

Words scale(const Words& in) {
  const Decimal decimal{in[0] != 0, u64(in[1]), u64(in[2]), static_cast<int>(in[3])};
  const ScaledDecimal scaled = scale_decimal(decimal, static_cast<int>(in[4]));
  return {scaled.overflow ? 1 : 0, scaled.value};
}

/// The text of a raw, as a sign and the digits before and after the point.
Words format(const Words& in) {
  const Decimal decimal = parse_decimal_text(format_decimal(in[0], static_cast<int>(in[1]))).value;
  return {decimal.negative ? 1 : 0, i64(decimal.whole), i64(decimal.fraction),
          decimal.fraction_digits};
}

/// The quotient must fit: the high word below the divisor.
void fit_quotient(Words& in) {
  const std::uint64_t divisor = u64(in[2]);
  in[0] = i64(u64(in[0]) % divisor);
}

/// A mantissa is zero with its exponent, or has its top bit.
void fit_block(Words& in, std::size_t at) {
  if (in[at] == 0) in[at + 1] = 0;
  if (in[at] != 0) in[at] |= std::int64_t{1} << 30;
}

void fit_factor(Words& in) {
  fit_block(in, 1);
}

void fit_two_blocks(Words& in) {
  fit_block(in, 0);
  fit_block(in, 2);
}

/// The fraction must have no more digits than it says.
void fit_fraction(Words& in) {
  std::uint64_t limit = 1;
  for (std::int64_t i = 0; i < in[3]; ++i)
    limit *= 10;
  in[2] = i64(u64(in[2]) % limit);
}

}  // namespace

std::vector<Function> arithmetic_functions() {
  using W = const Words&;
  return {
      {"round_shift",
       {below(61), k_shift},
       [](W in) -> Words { return {raw::round_shift(in[0], i32(in[1]))}; }},
      {"round_shift_any",
       {k_any64, k_shift},
       [](W in) -> Words { return {raw::round_shift_any(in[0], i32(in[1]))}; }},
      {"round_divide",
       {below(62), k_positive64},
       [](W in) -> Words { return {raw::round_divide(in[0], in[1])}; }},
      {"multiply_shift",
       {below(45), k_any32, {14, 62}},
       [](W in) -> Words { return {raw::multiply_shift(in[0], i32(in[1]), i32(in[2]))}; }},
      {"saturating_add",
       {k_any64, k_any64},
       [](W in) -> Words { return {raw::saturating_add(in[0], in[1])}; }},
      {"multiply_wide",
       {k_any64, k_any64},
       [](W in) -> Words { return words(multiply_wide(u64(in[0]), u64(in[1]))); }},
      {"divide_wide",
       {k_any64, k_any64, k_positive64},
       [](W in) -> Words {
         const Quotient64 q = divide({u64(in[0]), u64(in[1])}, u64(in[2]));
         return {i64(q.quotient), i64(q.remainder)};
       },
       fit_quotient},
      {"round_shift_wide",
       {k_any64, k_any64, {0, 127}},
       [](W in) -> Words {
         return words(round_shift(Int128{in[0], u64(in[1])}, i32(in[2])).bits());
       }},
      {"scale_decimal",
       {{0, 1}, {0, 999999999999999999}, {0, 999999999999999999}, {0, 18}, {0, 62}},
       scale,
       fit_fraction},
      {"format_decimal", {{-(k_max64 >> 4), k_max64 >> 4}, {2, 44}}, format},
      {"divide",
       {k_any64, k_any64, {-63, 63}},
       [](W in) -> Words { return {divide_raw_saturating(in[0], in[1], i32(in[2]))}; }},
      {"exp2",
       {k_any32, {0, 32}, {0, 31}},
       [](W in) -> Words { return {i64(exp2_raw(i32(in[0]), i32(in[1]), i32(in[2])))}; }},
      {"log2",
       {k_positive64, {0, 62}, {0, 56}},
       [](W in) -> Words { return {log2_raw(in[0], i32(in[1]), i32(in[2]))}; }},
      {"block_float",
       {k_any64, {-50, 50}},
       [](W in) -> Words { return words(block_float(u64(in[0]), i32(in[1]))); }},
      {"inverse_of",
       {{0, k_max64}},
       [](W in) -> Words { return words(inverse_of(Mass::from_raw(in[0]))); }},
      {"scale_saturating",
       {k_any64, k_mantissa, k_exponent, {-120, 120}},
       [](W in) -> Words { return {scale_saturating(in[0], block_at(in, 1), i32(in[3]))}; },
       fit_factor},
      {"ratio",
       {k_mantissa, k_exponent, k_mantissa, k_exponent},
       [](W in) -> Words { return {ratio(block_at(in, 0), block_at(in, 2)).raw}; },
       fit_two_blocks},
      {"block_add",
       {k_mantissa, k_exponent, k_mantissa, k_exponent},
       [](W in) -> Words { return words(add(block_at(in, 0), block_at(in, 2))); },
       fit_two_blocks},
  };
}

}  // namespace lockstone::numerics
