#include "tools/assets/scientific_decimal.h"

#include <algorithm>
#include <string>

#include <lockstone/asset.h>

#include "core/math/int128.h"

namespace lockstone::assets {
namespace {

constexpr int k_max_exponent = 99;

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The rest of a text that is read from the front.
struct Cursor {
  std::string_view rest;

  bool take(char c) {
    if (rest.empty() || rest.front() != c) return false;
    rest.remove_prefix(1);
    return true;
  }
  std::string_view take_digits() {
    const auto end = std::ranges::find_if_not(rest, is_digit);
    const auto digits = rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
    rest.remove_prefix(digits.size());
    return digits;
  }
  /// True for minus.
  bool take_sign() { return take('-') || (take('+') && false); }
};

/// The value of a run of digits that fits.
std::uint64_t value_of(std::string_view digits) {
  std::uint64_t value = 0;
  for (const char c : digits)
    value = 10 * value + static_cast<std::uint64_t>(c - '0');
  return value;
}

/// Nothing when there is an `e` without a legal exponent behind it; 0 without an `e`.
std::optional<int> read_exponent(Cursor& cursor) {
  if (!cursor.take('e') && !cursor.take('E')) return 0;
  const bool negative = cursor.take_sign();
  const std::string_view digits = cursor.take_digits();
  if (digits.empty() || digits.size() > 3) return std::nullopt;
  const int value = static_cast<int>(value_of(digits));
  if (value > k_max_exponent) return std::nullopt;
  return negative ? -value : value;
}

UInt128 times_ten(UInt128 x) {
  return (x << 3) + (x << 1);
}

/// numerator / denominator · 2^20 to nearest; numerator < 2^11 · denominator < 2^121.
std::int64_t divide_to_raw(UInt128 numerator, UInt128 denominator) {
  std::int64_t quotient = 0;
  for (int bit = 10; bit >= 0; --bit) {
    quotient *= 2;
    if (numerator < (denominator << bit)) continue;
    numerator = numerator - (denominator << bit);
    ++quotient;
  }
  for (int bit = 0; bit < Length::frac_bits; ++bit) {
    numerator = numerator << 1;
    quotient *= 2;
    if (numerator < denominator) continue;
    numerator = numerator - denominator;
    ++quotient;
  }
  return (numerator << 1) >= denominator ? quotient + 1 : quotient;
}

}  // namespace

std::optional<ScientificDecimal> read_scientific(std::string_view text, int max_digits) {
  Cursor cursor{text};
  ScientificDecimal result;
  result.negative = cursor.take_sign();
  const std::string_view whole = cursor.take_digits();
  const std::string_view fraction = cursor.take('.') ? cursor.take_digits() : std::string_view{};
  const std::optional<int> exponent = read_exponent(cursor);
  if (whole.empty() && fraction.empty()) return std::nullopt;
  if (!exponent || !cursor.rest.empty()) return std::nullopt;
  std::string digits = std::string(whole) + std::string(fraction);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  result.exponent = *exponent - static_cast<int>(fraction.size());
  while (!digits.empty() && digits.back() == '0') {
    digits.pop_back();
    ++result.exponent;
  }
  if (digits.size() > static_cast<std::size_t>(max_digits)) return std::nullopt;
  result.digits = value_of(digits);
  return result;
}

std::optional<Length> scaled_length(const ScientificDecimal& value,
                                    const ScientificDecimal& scale) {
  UInt128 numerator = multiply_wide(value.digits, scale.digits);  // below 10^27
  UInt128 denominator{0, 1};
  int exponent = value.exponent + scale.exponent;
  if (numerator == UInt128{} || exponent < -33) return Length{};  // below 10^-7 m: less than half
  for (; exponent < 0; ++exponent)
    denominator = times_ten(denominator);  // at most 10^33 < 2^110
  for (; exponent > 0 && numerator < UInt128{0, 1 << 12}; --exponent)
    numerator = times_ten(numerator);
  if (exponent > 0 || numerator >= (denominator << 11)) return std::nullopt;
  const std::int64_t raw = divide_to_raw(numerator, denominator);
  if (raw > k_max_asset_coordinate.raw) return std::nullopt;
  const bool negative = value.negative != scale.negative;
  return Length::from_raw(static_cast<std::int32_t>(negative ? -raw : raw));
}

}  // namespace lockstone::assets
