// Decimal literals: `1.5_m`, `-9.81_mps2`, `0.6_r`. A literal is an exact decimal that becomes any
// format of its unit, correctly rounded; a literal that does not fit does not compile.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <lockstone/decimal.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

namespace literal_detail {

/// whole + fraction · 2^-64, rounded down; ≥ 0.
struct Binary {
  std::uint64_t whole = 0;
  std::uint64_t fraction = 0;
};

[[nodiscard]] constexpr Binary binary(const Decimal& decimal) {
  std::uint64_t divisor = 1;
  for (int i = 0; i < decimal.fraction_digits; ++i)
    divisor *= 10;
  Binary result{decimal.whole, 0};
  std::uint64_t remainder = decimal.fraction;
  for (int i = 0; i < 64; ++i) {  // long division, one bit of the quotient a step
    remainder *= 2;
    const std::uint64_t bit = remainder >= divisor ? 1 : 0;
    remainder -= bit * divisor;
    result.fraction = result.fraction * 2 + bit;
  }
  return result;
}

/// The number of bits before the point · 65 + the number of ones that follow in a row after a whole
/// part of ones alone: where they fill a format, rounding up leaves it.
[[nodiscard]] constexpr int extent(const Binary& value) {
  const auto bits = static_cast<int>(std::bit_width(value.whole));
  const bool all_ones = (value.whole & (value.whole + 1)) == 0;
  return bits * 65 + (all_ones ? std::countl_one(value.fraction) : 0);
}

/// Of the negative, where −2^n takes no bit more than the numbers above it.
[[nodiscard]] constexpr int mirrored_extent(const Binary& value) {
  const bool is_power = value.fraction == 0 && std::has_single_bit(value.whole);
  return is_power ? (static_cast<int>(std::bit_width(value.whole)) - 1) * 65 : extent(value);
}

[[nodiscard]] constexpr int whole_bits(int extent) {
  return extent / 65 + (extent % 65 > 30 ? 1 : 0);
}

[[nodiscard]] constexpr bool fits(int extent, std::size_t word_bits, int frac_bits) {
  const int room = static_cast<int>(word_bits) - 1 - frac_bits;
  return extent / 65 < room || (extent / 65 == room && extent % 65 <= frac_bits);
}

/// value · π / 180 for a value below 2^16.
[[nodiscard]] constexpr Binary radians(const Binary& degrees) {
  constexpr std::uint64_t k_degree = 321956420358983237U;  // π / 180 · 2^64
  constexpr std::uint64_t k_low = k_degree & 0xffffffff, k_high = k_degree >> 32;
  if (degrees.whole > 0xffff) misused("an angle above 65535 degrees");
  const std::uint64_t low = degrees.whole * k_low;
  const std::uint64_t high = degrees.whole * k_high + (low >> 32);
  const std::uint64_t part =
      (degrees.fraction >> 32) * k_high + (((degrees.fraction >> 32) * k_low) >> 32);
  const std::uint64_t fraction = (high << 32) | (low & 0xffffffff);
  const std::uint64_t sum = fraction + part;
  return {(high >> 32) + (sum < fraction ? 1U : 0U), sum};
}

}  // namespace literal_detail

/// A decimal with a unit, not yet in any binary format: whole + fraction · 2^-64, rounded down,
/// which is enough to round it once and right to every format.
///
/// `Extent` bounds the size of the value, `Mirror` that of its negative, so that a conversion
/// exists only where the value fits. A literal becomes one of a greater extent by itself: `b ?
/// 0.5_m : 2_m`.
template <class Dim, int Extent, int Mirror>
struct DecimalLiteral {
  bool negative = false;
  std::uint64_t whole = 0;
  std::uint64_t fraction = 0;

  constexpr DecimalLiteral<Dim, Mirror, Extent> operator-() const {
    return {!negative, whole, fraction};
  }

  template <int Extent2, int Mirror2>
  requires(Extent < Extent2 || (Extent == Extent2 && Mirror < Mirror2)) constexpr
  operator DecimalLiteral<Dim, Extent2, Mirror2>() const {  // NOLINT(google-explicit-constructor)
    return {negative, whole, fraction};
  }

  template <class Rep, int FracBits>
  requires(literal_detail::fits(Extent, sizeof(Rep) * 8, FracBits)) constexpr
  operator Fixed<Dim, Rep, FracBits>() const {                // NOLINT(google-explicit-constructor)
    const std::uint64_t below = fraction >> (63 - FracBits);  // one bit more than the format has
    const std::uint64_t size = (whole << FracBits) + (below >> 1) + (below & 1);
    return Fixed<Dim, Rep, FracBits>::from_raw(static_cast<Rep>(negative ? 0 - size : size));
  }
};

/// A quantity times a plain literal: the same quantity, rounded once; must fit. `2_r * x` likewise.
template <class D, class Rep, int F, int Extent, int Mirror>
[[nodiscard]] constexpr Fixed<D, Rep, F> operator*(Fixed<D, Rep, F> a,
                                                   DecimalLiteral<Scalar, Extent, Mirror> factor) {
  constexpr int k_bits = 30 - literal_detail::whole_bits(Extent);
  static_assert(k_bits >= 0, "the factor is too great");
  return scaled(a, static_cast<Fixed<Scalar, std::int32_t, k_bits>>(factor));
}
template <class D, class Rep, int F, int Extent, int Mirror>
[[nodiscard]] constexpr Fixed<D, Rep, F> operator*(DecimalLiteral<Scalar, Extent, Mirror> factor,
                                                   Fixed<D, Rep, F> a) {
  return a * factor;
}
template <class T, int Extent, int Mirror>
[[nodiscard]] constexpr Vec3<T> operator*(const Vec3<T>& v,
                                          DecimalLiteral<Scalar, Extent, Mirror> factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}
template <class T, int Extent, int Mirror>
[[nodiscard]] constexpr Vec3<T> operator*(DecimalLiteral<Scalar, Extent, Mirror> factor,
                                          const Vec3<T>& v) {
  return v * factor;
}

/// A literal has no format to compute in: give it one first, as in Length(2_m) * i.
template <class Dim, int Extent, int Mirror>
auto operator*(DecimalLiteral<Dim, Extent, Mirror>, int) = delete;  // Length(2_m) * i, say
template <class Dim, int Extent, int Mirror>
auto operator*(int, DecimalLiteral<Dim, Extent, Mirror>) = delete;  // i * Length(2_m), say

namespace literals {

template <char... Text>
[[nodiscard]] constexpr Decimal parse_literal() {
  constexpr char text[] = {Text...};
  constexpr ParsedDecimal parsed = parse_decimal_text({text, sizeof...(Text)});
  static_assert(parsed.ok, "not a decimal literal");
  return parsed.value;
}

/// The literal of a value that the text gives: a Binary, made by the compiler.
template <class Dim, literal_detail::Binary Value>
[[nodiscard]] constexpr auto make_literal() {
  return DecimalLiteral<Dim, literal_detail::extent(Value), literal_detail::mirrored_extent(Value)>{
      false, Value.whole, Value.fraction};
}

template <class Dim, char... Text>
[[nodiscard]] constexpr auto literal() {
  return make_literal<Dim, literal_detail::binary(parse_literal<Text...>())>();
}

// clang-format off
template <char... T> constexpr auto operator""_m() { return literal<Metre, T...>(); }
template <char... T> constexpr auto operator""_kg() { return literal<Kilogram, T...>(); }
template <char... T> constexpr auto operator""_rad() { return literal<Scalar, T...>(); }
template <char... T> constexpr auto operator""_r() { return literal<Scalar, T...>(); }
template <char... T> constexpr auto operator""_mps() { return literal<MetrePerSecond, T...>(); }
template <char... T> constexpr auto operator""_mps2() { return literal<MetrePerSecond2, T...>(); }
template <char... T> constexpr auto operator""_rps() { return literal<PerSecond, T...>(); }
template <char... T> constexpr auto operator""_Ns() { return literal<NewtonSecond, T...>(); }
template <char... T> constexpr auto operator""_Nms() { return literal<NewtonMetreSecond, T...>(); }
template <char... T> constexpr auto operator""_N() { return literal<Newton, T...>(); }
template <char... T> constexpr auto operator""_Nm() { return literal<NewtonMetre, T...>(); }
template <char... T> constexpr auto operator""_kgpm3() { return literal<KilogramPerMetre3, T...>(); }
// clang-format on

/// Degrees, as radians: at most 65535, in error by less than 2^-40.
template <char... T>
constexpr auto operator""_deg() {
  return make_literal<Scalar,
                      literal_detail::radians(literal_detail::binary(parse_literal<T...>()))>();
}

}  // namespace literals
}  // namespace lockstone
