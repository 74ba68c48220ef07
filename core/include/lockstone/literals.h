// Decimal literals: `1.5_m`, `-9.81_mps2`, `0.6_r`. A literal is an exact decimal that becomes any
// format of its unit at compile time, correctly rounded; what does not fit does not compile.
#pragma once

#include <cstdint>

#include <lockstone/decimal.h>
#include <lockstone/units.h>

namespace lockstone {

/// An exact decimal with a unit, not yet in any binary format. The value is part of the type, so that
/// a conversion is always done by the compiler, and exists only where the value fits.
template <class Dim, Decimal Value>
struct DecimalLiteral {
  constexpr auto operator-() const {
    constexpr Decimal negated = {!Value.negative, Value.whole, Value.fraction,
                                 Value.fraction_digits};
    return DecimalLiteral<Dim, negated>{};
  }

  template <class Rep, int FracBits>
    requires(scale_decimal(Value, FracBits).fits_in(sizeof(Rep) * 8))
  constexpr operator Fixed<Dim, Rep, FracBits>() const {  // NOLINT(google-explicit-constructor)
    constexpr ScaledDecimal scaled = scale_decimal(Value, FracBits);
    return {static_cast<Rep>(scaled.value)};
  }
};

namespace literals {

template <char... Text>
[[nodiscard]] constexpr Decimal parse_literal() {
  constexpr char text[] = {Text...};
  constexpr ParsedDecimal parsed = parse_decimal_text({text, sizeof...(Text)});
  static_assert(parsed.ok, "not a decimal literal");
  return parsed.value;
}

template <class Dim, char... Text>
using Literal = DecimalLiteral<Dim, parse_literal<Text...>()>;

// clang-format off
template <char... T> constexpr Literal<Metre, T...> operator""_m() { return {}; }
template <char... T> constexpr Literal<Kilogram, T...> operator""_kg() { return {}; }
template <char... T> constexpr Literal<Scalar, T...> operator""_rad() { return {}; }
template <char... T> constexpr Literal<Scalar, T...> operator""_r() { return {}; }
template <char... T> constexpr Literal<MetrePerSecond, T...> operator""_mps() { return {}; }
template <char... T> constexpr Literal<MetrePerSecond2, T...> operator""_mps2() { return {}; }
template <char... T> constexpr Literal<PerSecond, T...> operator""_rps() { return {}; }
template <char... T> constexpr Literal<NewtonSecond, T...> operator""_Ns() { return {}; }
template <char... T> constexpr Literal<NewtonMetreSecond, T...> operator""_Nms() { return {}; }
template <char... T> constexpr Literal<Newton, T...> operator""_N() { return {}; }
template <char... T> constexpr Literal<NewtonMetre, T...> operator""_Nm() { return {}; }
template <char... T> constexpr Literal<KilogramPerMetre3, T...> operator""_kgpm3() { return {}; }
// clang-format on

}  // namespace literals
}  // namespace lockstone
