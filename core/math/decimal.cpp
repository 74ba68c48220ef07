#include <algorithm>

#include <lockstone/decimal.h>

namespace lockstone {
namespace {

// `fraction` · 10^digits · 2^-frac_bits to nearest, one digit at a time so that nothing overflows:
// the remainder stays below 2^frac_bits ≤ 2^44 and ten times it below 2^48.
std::uint64_t fraction_digits_of(std::uint64_t fraction, int frac_bits, int digits) {
  const std::uint64_t mask = (std::uint64_t{1} << frac_bits) - 1;
  std::uint64_t result = 0;
  for (int i = 0; i < digits; ++i) {
    fraction *= 10;
    result = result * 10 + (fraction >> frac_bits);
    fraction &= mask;
  }
  const bool round_up = frac_bits > 0 && ((fraction >> (frac_bits - 1)) & 1) != 0;
  return result + (round_up ? 1 : 0);
}

std::string assemble(bool negative, std::uint64_t whole, std::uint64_t fraction, int digits) {
  std::uint64_t scale = 1;
  for (int i = 0; i < digits; ++i)
    scale *= 10;
  if (fraction >= scale) {  // the rounding carried into the whole part
    fraction -= scale;
    ++whole;
  }
  std::string text(negative ? 1 : 0, '-');
  text += std::to_string(whole);
  if (digits == 0) return text;
  std::string tail = std::to_string(fraction);
  tail.insert(tail.begin(), static_cast<std::size_t>(digits) - tail.size(), '0');
  return text + '.' + tail;
}

}  // namespace

std::string format_decimal(std::int64_t raw, int frac_bits) {
  LKS_CHECK(frac_bits >= 0 && frac_bits <= 44);
  const bool negative = raw < 0;
  const std::uint64_t magnitude =
      negative ? 0 - static_cast<std::uint64_t>(raw) : static_cast<std::uint64_t>(raw);
  const std::uint64_t whole = magnitude >> frac_bits;
  const std::uint64_t fraction = magnitude & ((std::uint64_t{1} << frac_bits) - 1);
  std::string text;
  for (int digits = 0; digits <= 14; ++digits) {
    text = assemble(negative, whole, fraction_digits_of(fraction, frac_bits, digits), digits);
    const ParsedDecimal parsed = parse_decimal_text(text);
    if (!parsed.ok) break;  // over 18 whole digits: a format without fraction bits
    const ScaledDecimal back = scale_decimal(parsed.value, frac_bits);
    if (!back.overflow && back.value == raw) break;
  }
  return text;
}

}  // namespace lockstone
