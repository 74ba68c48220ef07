// Decimal text to fixed point and back, exactly: parsing rounds once, formatting round-trips.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>

#include <lockstone/fixed.h>
#include <lockstone/status.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// ± (whole + fraction · 10^-fraction_digits). Up to 18 digits on each side of the point.
struct Decimal {
  bool negative = false;
  std::uint64_t whole = 0;
  std::uint64_t fraction = 0;
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

namespace decimal_detail {

/// A run of digits, with `'` allowed between two of them. `count` is zero when there is none, and
/// above 18 when there are too many.
struct DigitRun {
  std::uint64_t value = 0;
  int count = 0;
};

[[nodiscard]] constexpr bool is_digit(std::string_view text, std::size_t at) {
  return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

[[nodiscard]] constexpr DigitRun read_digits(std::string_view text, std::size_t& at) {
  DigitRun run;
  while (is_digit(text, at) && run.count <= 18) {
    run.value = run.value * 10 + static_cast<std::uint64_t>(text[at++] - '0');
    ++run.count;
    if (at < text.size() && text[at] == '\'' && is_digit(text, at + 1)) ++at;
  }
  return run;
}

}  // namespace decimal_detail

/// Reads `[+-]digits[.digits]`, with `'` allowed between digits. No exponent; at most 18 digits on
/// each side of the point.
[[nodiscard]] constexpr ParsedDecimal parse_decimal_text(std::string_view text) {
  using decimal_detail::DigitRun;
  const bool has_sign = !text.empty() && (text[0] == '-' || text[0] == '+');
  std::size_t at = has_sign ? 1 : 0;
  const DigitRun whole = decimal_detail::read_digits(text, at);
  const bool has_point = at < text.size() && text[at] == '.';
  if (has_point) ++at;
  const DigitRun fraction = has_point ? decimal_detail::read_digits(text, at) : DigitRun{};
  const bool digits_ok = whole.count > 0 && whole.count <= 18 && fraction.count <= 18;
  if (!digits_ok || has_point != (fraction.count > 0) || at != text.size()) return {};
  return {true, {has_sign && text[0] == '-', whole.value, fraction.value, fraction.count}};
}

/// `decimal` · 2^frac_bits, rounded; 0 ≤ frac_bits ≤ 62.
[[nodiscard]] constexpr ScaledDecimal scale_decimal(const Decimal& decimal, int frac_bits) {
  std::uint64_t divisor = 1;
  for (int i = 0; i < decimal.fraction_digits; ++i)
    divisor *= 10;
  std::uint64_t magnitude = decimal.whole;
  std::uint64_t remainder = decimal.fraction;
  bool overflow = false;
  for (int i = 0; i < frac_bits; ++i) {  // long division, one bit of the quotient a step
    remainder *= 2;
    const std::uint64_t bit = remainder >= divisor ? 1 : 0;
    remainder -= bit * divisor;
    overflow = overflow || magnitude >= (std::uint64_t{1} << 63);
    magnitude = magnitude * 2 + bit;
  }
  if (remainder * 2 >= divisor) ++magnitude;
  const std::uint64_t bound = std::uint64_t{0x7fffffffffffffff} + (decimal.negative ? 1 : 0);
  if (overflow || magnitude > bound) return {true, 0};
  return {false, static_cast<std::int64_t>(decimal.negative ? 0 - magnitude : magnitude)};
}

/// Parses decimal text into the format T, correctly rounded. Status::malformed for other text,
/// Status::invalid_argument for a value outside T's range.
template <class T>
[[nodiscard]] Result<T> parse_decimal(std::string_view text) {
  const ParsedDecimal parsed = parse_decimal_text(text);
  if (!parsed.ok) return Status::malformed;
  const ScaledDecimal scaled = scale_decimal(parsed.value, T::frac_bits);
  if (!scaled.fits_in(sizeof(typename T::Representation) * 8)) return Status::invalid_argument;
  return T::from_raw(static_cast<typename T::Representation>(scaled.value));
}

/// Formats with more fraction bits, those of exact products, have no short decimals.
inline constexpr int k_most_decimal_bits = 44;

/// The shortest decimal that parses back to the same value of a format with `frac_bits` ≤ 44.
[[nodiscard]] std::string format_decimal(std::int64_t raw, int frac_bits);

/// The number without its unit: "-0.25". Parses back to the same value.
template <class T>
[[nodiscard]] std::string to_decimal(T value) {
  static_assert(T::frac_bits <= k_most_decimal_bits,
                "an exact product has no short decimal: use rounded<To> first");
  return format_decimal(value.raw, T::frac_bits);
}

/// "(1, -0.25, 3)".
template <class D, class Rep, int F>
[[nodiscard]] std::string to_decimal(const Vec3<Fixed<D, Rep, F>>& v) {
  return '(' + to_decimal(v.x) + ", " + to_decimal(v.y) + ", " + to_decimal(v.z) + ')';
}

/// As `to_decimal`.
template <class Traits, class D, class Rep, int F>
requires(F <= k_most_decimal_bits) std::basic_ostream<char, Traits>
&operator<<(std::basic_ostream<char, Traits>& out, Fixed<D, Rep, F> value) {
  return out << std::string_view(to_decimal(value));
}
template <class Traits, class D, class Rep, int F>
requires(F <= k_most_decimal_bits) std::basic_ostream<char, Traits>
&operator<<(std::basic_ostream<char, Traits>& out, const Vec3<Fixed<D, Rep, F>>& v) {
  return out << std::string_view(to_decimal(v));
}

}  // namespace lockstone
