// Decimal literals: `1.5_m`, `-9.81_mps2`, `0.6_r`. A literal is an exact decimal that becomes any
// format of its unit at compile time, correctly rounded; what does not fit does not compile.
#pragma once

#include <cstdint>

#include <lockstone/decimal.h>
#include <lockstone/units.h>

namespace lockstone {

/// An exact decimal with a unit, not yet in any binary format.
template <class Dim>
struct DecimalLiteral {
  Decimal value;

  consteval DecimalLiteral operator-() const {
    return {{!value.negative, value.whole, value.fraction, value.fraction_digits}};
  }

  template <class Rep, int FracBits>
  consteval operator Fixed<Dim, Rep, FracBits>() const {  // NOLINT(google-explicit-constructor)
    const ScaledDecimal scaled = scale_decimal(value, FracBits);
    if (!scaled.fits_in(sizeof(Rep) * 8)) literal_does_not_fit();
    return {static_cast<Rep>(scaled.value)};
  }

 private:
  static void literal_does_not_fit() {}  // not constexpr: reaching it fails the compilation
};

namespace literals {

template <char... Text>
[[nodiscard]] consteval Decimal parse_literal() {
  constexpr char text[] = {Text...};
  const ParsedDecimal parsed = parse_decimal_text({text, sizeof...(Text)});
  return parsed.ok ? parsed.value : throw "not a decimal literal";
}

// clang-format off
template <char... T> consteval DecimalLiteral<Metre> operator""_m() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<Kilogram> operator""_kg() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<Scalar> operator""_rad() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<Scalar> operator""_r() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<MetrePerSecond> operator""_mps() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<MetrePerSecond2> operator""_mps2() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<PerSecond> operator""_rps() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<NewtonSecond> operator""_Ns() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<Newton> operator""_N() { return {parse_literal<T...>()}; }
template <char... T> consteval DecimalLiteral<KilogramPerMetre3> operator""_kgpm3() { return {parse_literal<T...>()}; }
// clang-format on

}  // namespace literals
}  // namespace lockstone
