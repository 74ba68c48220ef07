// Decimal text to fixed point and back, exactly: parsing rounds once, formatting round-trips.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <lockstone/fixed.h>
#include <lockstone/status.h>

namespace lockstone {

/// ± digits · 10^-fraction_digits; up to 18 significant digits.
struct Decimal {
  bool negative = false;
  std::uint64_t digits = 0;
  int fraction_digits = 0;
};

struct ParsedDecimal {
  bool ok = false;
  Decimal value;
};

/// A decimal scaled by a power of two and rounded to nearest, ties away from zero.
struct ScaledDecimal {
  bool overflow = false;
  std::int64_t value = 0;

  [[nodiscard]] constexpr bool fits_in(std::size_t bits) const {
    const std::int64_t bound = std::int64_t{1} << (bits < 64 ? bits - 1 : 62);
    return !overflow && (bits >= 64 || (value >= -bound && value < bound));
  }
};

/// Reads `[+-]digits[.digits]`, with `'` allowed between digits. No exponent, at most 18 digits.
[[nodiscard]] constexpr ParsedDecimal parse_decimal_text(std::string_view text) {
  ParsedDecimal result;
  std::size_t at = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) {
    result.value.negative = text[at++] == '-';
  }
  int digit_count = 0;
  bool after_point = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\'' && digit_count > 0) continue;
    if (c == '.' && !after_point) {
      after_point = true;
      continue;
    }
    if (c < '0' || c > '9' || ++digit_count > 18) return {};
    result.value.digits = result.value.digits * 10 + static_cast<std::uint64_t>(c - '0');
    result.value.fraction_digits += after_point ? 1 : 0;
  }
  result.ok = digit_count > 0;
  return result;
}

/// `decimal` · 2^frac_bits, rounded; 0 ≤ frac_bits ≤ 62.
[[nodiscard]] constexpr ScaledDecimal scale_decimal(const Decimal& decimal, int frac_bits) {
  std::uint64_t divisor = 1;
  for (int i = 0; i < decimal.fraction_digits; ++i) divisor *= 10;
  std::uint64_t magnitude = decimal.digits / divisor;
  std::uint64_t remainder = decimal.digits % divisor;
  bool overflow = false;
  for (int i = 0; i < frac_bits; ++i) {  // long division, one bit of the quotient a step
    remainder *= 2;
    const std::uint64_t bit = remainder >= divisor ? 1 : 0;
    remainder -= bit * divisor;
    overflow = overflow || magnitude >= (std::uint64_t{1} << 62);
    magnitude = magnitude * 2 + bit;
  }
  if (remainder * 2 >= divisor) ++magnitude;
  overflow = overflow || magnitude > std::uint64_t{0x7fffffffffffffff};
  if (overflow) return {true, 0};
  const auto value = static_cast<std::int64_t>(magnitude);
  return {false, decimal.negative ? -value : value};
}

/// Parses decimal text into the format T, correctly rounded. Status::malformed for other text,
/// Status::invalid_argument for a value outside T's range.
template <class T>
[[nodiscard]] constexpr Result<T> parse_decimal(std::string_view text) {
  const ParsedDecimal parsed = parse_decimal_text(text);
  if (!parsed.ok) return Status::malformed;
  const ScaledDecimal scaled = scale_decimal(parsed.value, T::frac_bits);
  if (!scaled.fits_in(sizeof(typename T::Representation) * 8)) return Status::invalid_argument;
  return T{static_cast<typename T::Representation>(scaled.value)};
}

/// The shortest decimal that parses back to the same value of a format with `frac_bits` ≤ 44.
[[nodiscard]] std::string format_decimal(std::int64_t raw, int frac_bits);

template <class T>
[[nodiscard]] std::string to_decimal(T value) {
  return format_decimal(value.raw, T::frac_bits);
}

}  // namespace lockstone
