// Typed fixed-point numbers: a value is `raw · 2^-FracBits` of its unit.
//
// Adding unlike quantities does not compile; a product of two 32-bit quantities is exact in 64 bits
// and carries the product of the units, and `rounded<To>` brings it back. There is one rounding
// rule: to nearest, ties away from zero. It is odd, f(-x) = -f(x), so a mirrored scene stays a
// mirrored scene and no bias can act as a phantom force.
#pragma once

#include <bit>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone {

/// Powers of metre, kilogram and second. Radians and plain numbers have none.
template <int Metres, int Kilograms, int Seconds>
struct Dimension {
  static constexpr int metres = Metres;
  static constexpr int kilograms = Kilograms;
  static constexpr int seconds = Seconds;
};

template <class A, class B>
using DimensionProduct =
    Dimension<A::metres + B::metres, A::kilograms + B::kilograms, A::seconds + B::seconds>;

/// The raw integer rules that every typed operation is built from.
namespace raw {

/// Two's complement sum and difference: defined for all inputs; leaving the range is a programmer's
/// error that asserts report.
template <std::signed_integral T>
[[nodiscard]] constexpr T add(T a, T b) {
  using U = std::make_unsigned_t<T>;
  const T sum = static_cast<T>(static_cast<U>(a) + static_cast<U>(b));
  LKS_ASSERT((b >= 0) == (sum >= a));
  return sum;
}

template <std::signed_integral T>
[[nodiscard]] constexpr T subtract(T a, T b) {
  using U = std::make_unsigned_t<T>;
  const T difference = static_cast<T>(static_cast<U>(a) - static_cast<U>(b));
  LKS_ASSERT((b >= 0) == (difference <= a));
  return difference;
}

/// Clamps `x` to the range of T.
template <std::signed_integral T>
[[nodiscard]] constexpr T saturate(std::int64_t x) {
  if (x > std::numeric_limits<T>::max()) return std::numeric_limits<T>::max();
  if (x < std::numeric_limits<T>::min()) return std::numeric_limits<T>::min();
  return static_cast<T>(x);
}

/// a + b, clamped to the range of int64.
[[nodiscard]] constexpr std::int64_t saturating_add(std::int64_t a, std::int64_t b) {
  const auto sum =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
  const bool overflow = ((a ^ sum) & (b ^ sum)) < 0;
  if (!overflow) return sum;
  return a < 0 ? std::numeric_limits<std::int64_t>::min()
               : std::numeric_limits<std::int64_t>::max();
}

/// x · 2^-shift to nearest, ties away from zero. 0 ≤ shift ≤ 62 and |x| < 2^63 − 2^(shift−1).
[[nodiscard]] constexpr std::int64_t round_shift(std::int64_t x, int shift) {
  LKS_ASSERT(shift >= 0 && shift <= 62);
  if (shift == 0) return x;
  const std::int64_t half = std::int64_t{1} << (shift - 1);
  return add(x, half + (x >> 63)) >> shift;
}

/// As `round_shift`, for every x.
[[nodiscard]] constexpr std::int64_t round_shift_any(std::int64_t x, int shift) {
  LKS_ASSERT(shift >= 0 && shift <= 62);
  if (shift == 0) return x;
  const std::uint64_t sign = x < 0 ? ~std::uint64_t{0} : 0;
  const std::uint64_t size = (static_cast<std::uint64_t>(x) ^ sign) - sign;
  const std::uint64_t result = (size + (std::uint64_t{1} << (shift - 1))) >> shift;
  return static_cast<std::int64_t>((result ^ sign) - sign);
}

/// x · 2^shift for either sign of `shift`; rounds when it shrinks, must fit when it grows.
[[nodiscard]] constexpr std::int64_t scale_binary(std::int64_t x, int shift) {
  if (shift <= 0) return round_shift(x, -shift);
  LKS_ASSERT(((x << shift) >> shift) == x);
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(x) << shift);
}

/// numerator / denominator to nearest, ties away from zero. denominator > 0, |numerator| ≤ 2^62.
[[nodiscard]] constexpr std::int64_t round_divide(std::int64_t numerator,
                                                  std::int64_t denominator) {
  LKS_ASSERT(denominator > 0);
  const std::int64_t quotient = numerator / denominator;
  const std::int64_t remainder = numerator % denominator;
  const std::int64_t magnitude = remainder < 0 ? -remainder : remainder;
  if (magnitude < denominator - magnitude) return quotient;
  return numerator < 0 ? quotient - 1 : quotient + 1;
}

/// x · 2^shift for either sign of `shift`: rounded, and clamped to the range of int64.
[[nodiscard]] constexpr std::int64_t scale_saturating(std::int64_t x, int shift) {
  if (shift <= 0) return round_shift_any(x, -shift);
  LKS_ASSERT(shift <= 62);
  const auto grown = static_cast<std::int64_t>(static_cast<std::uint64_t>(x) << shift);
  if (grown >> shift == x) return grown;
  return x < 0 ? std::numeric_limits<std::int64_t>::min()
               : std::numeric_limits<std::int64_t>::max();
}

/// The result of `divide`; `value` says nothing where it does not fit in int64.
struct Ratio {
  bool fits = false;
  std::int64_t value = 0;
};

/// numerator · 2^frac_bits / denominator to nearest, ties away from zero, for all numerators and
/// all denominators but 0; 0 ≤ frac_bits ≤ 62. Long division where the product would leave 62 bits.
[[nodiscard]] constexpr Ratio divide(std::int64_t numerator, std::int64_t denominator,
                                     int frac_bits) {
  const std::int64_t bound = std::int64_t{1} << (62 - frac_bits);
  if (denominator > 0 && numerator > -bound && numerator < bound)
    return {true, round_divide(numerator * (std::int64_t{1} << frac_bits), denominator)};
  const auto size = [](std::int64_t x) {
    return x < 0 ? 0 - static_cast<std::uint64_t>(x) : static_cast<std::uint64_t>(x);
  };
  const std::uint64_t divisor = size(denominator);
  std::uint64_t quotient = size(numerator) / divisor;
  std::uint64_t remainder = size(numerator) % divisor;  // below 2^63: twice it fits
  bool fits = true;
  for (int i = 0; i < frac_bits; ++i) {
    remainder *= 2;
    const std::uint64_t bit = remainder >= divisor ? 1 : 0;
    remainder -= bit * divisor;
    fits = fits && quotient < std::uint64_t{1} << 63;
    quotient = quotient * 2 + bit;
  }
  if (remainder >= divisor - remainder) ++quotient;
  const bool negative = (numerator < 0) != (denominator < 0);
  const std::uint64_t most = std::uint64_t{0x7fffffffffffffff} + (negative ? 1 : 0);
  return {fits && quotient <= most, static_cast<std::int64_t>(negative ? 0 - quotient : quotient)};
}

/// a · b · 2^-shift to nearest, ties away from zero, without a 128-bit product.
/// 1 ≤ shift ≤ 62; the result must fit in int64, and |a · b| < 2^(62 + shift).
[[nodiscard]] constexpr std::int64_t multiply_shift(std::int64_t a, std::int32_t b, int shift) {
  LKS_ASSERT(shift >= 1 && shift <= 62);
  if (shift <= 31) {
    // a = high · 2^shift + low, so the product is high · b + low · b · 2^-shift: |low · b| ≤ 2^62.
    // The first term may pass the range by as much as the second brings it back.
    const std::int64_t low = a & ((std::int64_t{1} << shift) - 1);
    const std::int64_t half = std::int64_t{1} << (shift - 1);
    const std::int64_t below_zero = (a ^ std::int64_t{b}) >> 63;  // −1 where the signs differ
    const std::int64_t part = (low * b + half + below_zero) >> shift;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a >> shift) *
                                         static_cast<std::uint64_t>(std::int64_t{b}) +
                                     static_cast<std::uint64_t>(part));
  }
  // |a| = high · 2^31 + low; both partial products fit in 64 bits.
  const bool negative = (a < 0) != (b < 0);
  const std::uint64_t ua =
      a < 0 ? 0 - static_cast<std::uint64_t>(a) : static_cast<std::uint64_t>(a);
  const std::uint64_t ub =
      b < 0 ? 0 - static_cast<std::uint64_t>(b) : static_cast<std::uint64_t>(b);
  const std::uint64_t low = (ua & 0x7fffffffU) * ub;
  const std::uint64_t high = (ua >> 31) * ub + (low >> 31);  // ⌊product · 2^-31⌋
  const std::uint64_t magnitude = (high + (std::uint64_t{1} << (shift - 32))) >> (shift - 31);
  const auto result = static_cast<std::int64_t>(magnitude);
  return negative ? -result : result;
}

}  // namespace raw

/// Whether every value of one format is a value of the other: as many bits before and behind the
/// point.
template <class FromRep, int FromBits, class ToRep, int ToBits>
concept HoldsAll = FromBits <= ToBits && sizeof(FromRep) * 8 + static_cast<std::size_t>(ToBits) <=
                                             sizeof(ToRep) * 8 + static_cast<std::size_t>(FromBits);

/// One quantity: unit, representation and binary point. Plain data; zero by default.
///
/// A bare number has no unit, so it does not convert: write `1.5_m`, `from_integer`, `from_ratio`,
/// or `from_raw` for the raw integer. Formats convert by themselves where no value can be lost (a
/// Length is a Position); elsewhere by `rounded`, `saturated` or `try_rounded`.
///
/// Leaving the range: `from_integer` and `from_ratio` do not compile in a constant expression and
/// stop the program at run time; operators and `rounded` assert, and wrap where assertions are off;
/// `saturated` clamps; the functions that begin with `try_` return nothing. None is undefined.
template <class Dim, std::signed_integral Rep, int FracBits>
struct Fixed {
  using Unit = Dim;
  using Representation = Rep;
  static constexpr int frac_bits = FracBits;

  Rep raw = 0;

  constexpr Fixed() = default;

  /// Write 1.5_m, Length::from_integer(2) or Length::from_raw(…) instead of a bare number.
  template <class Number>
  requires std::is_arithmetic_v<Number> Fixed(Number)
  = delete;  // a bare number has no unit: write 1.5_m

  /// From a format whose every value this one holds.
  template <class OtherRep, int OtherBits>
  requires HoldsAll<OtherRep, OtherBits, Rep, FracBits>
  constexpr Fixed(Fixed<Dim, OtherRep, OtherBits> other)  // NOLINT(google-explicit-constructor)
      : Fixed(Raw{static_cast<Rep>(Rep{other.raw} * (Rep{1} << (FracBits - OtherBits)))}) {}

  [[nodiscard]] static constexpr Fixed from_raw(Rep value) { return Fixed(Raw{value}); }

  /// `value` whole units. Must fit: stops the program otherwise.
  template <std::integral Integer>
  [[nodiscard]] static constexpr Fixed from_integer(Integer value) {
    if (!holds(value))
      misused("Fixed::from_integer: out of range; use a wider format, or try_from_integer");
    return from_raw(
        static_cast<Rep>(static_cast<std::int64_t>(value) * (std::int64_t{1} << FracBits)));
  }
  template <class Other>
  requires(!std::integral<Other>) static Fixed from_integer(Other) = delete;

  /// `value` whole units, or nothing where they do not fit.
  template <std::integral Integer>
  [[nodiscard]] static constexpr std::optional<Fixed> try_from_integer(Integer value) {
    if (!holds(value)) return std::nullopt;
    return from_integer(value);
  }

  /// numerator / denominator units, correctly rounded. The denominator must not be 0 and the result
  /// must fit: stops the program otherwise.
  [[nodiscard]] static constexpr Fixed from_ratio(std::int64_t numerator,
                                                  std::int64_t denominator) {
    if (denominator == 0) misused("Fixed::from_ratio: the denominator is 0");
    const raw::Ratio ratio = raw::divide(numerator, denominator, FracBits);
    if (!holds_raw(ratio))
      misused("Fixed::from_ratio: out of range; use a wider format, or try_from_ratio");
    return from_raw(static_cast<Rep>(ratio.value));
  }
  template <class A, class B>
  requires(!std::integral<A> || !std::integral<B>) static Fixed from_ratio(A, B) = delete;

  /// The same, or nothing where the denominator is 0 or the result does not fit.
  [[nodiscard]] static constexpr std::optional<Fixed> try_from_ratio(std::int64_t numerator,
                                                                     std::int64_t denominator) {
    if (denominator == 0) return std::nullopt;
    const raw::Ratio ratio = raw::divide(numerator, denominator, FracBits);
    if (!holds_raw(ratio)) return std::nullopt;
    return from_raw(static_cast<Rep>(ratio.value));
  }

  [[nodiscard]] static constexpr Fixed max() { return from_raw(std::numeric_limits<Rep>::max()); }
  [[nodiscard]] static constexpr Fixed min() { return from_raw(std::numeric_limits<Rep>::min()); }

  friend constexpr auto operator<=>(Fixed, Fixed) = default;

  friend constexpr Fixed operator+(Fixed a, Fixed b) { return from_raw(raw::add(a.raw, b.raw)); }
  friend constexpr Fixed operator-(Fixed a, Fixed b) {
    return from_raw(raw::subtract(a.raw, b.raw));
  }
  constexpr Fixed operator-() const { return Fixed{} - *this; }
  constexpr Fixed& operator+=(Fixed b) { return *this = *this + b; }
  constexpr Fixed& operator-=(Fixed b) { return *this = *this - b; }

  /// Times a whole number; must fit.
  friend constexpr Fixed operator*(Fixed a, int factor) {
    const auto product = static_cast<std::int64_t>(static_cast<std::uint64_t>(a.raw) *
                                                   static_cast<std::uint64_t>(factor));
    // By −1 apart: product / −1 would overflow where the product does.
    LKS_ASSERT(factor == -1 ? a.raw == 0 || product != a.raw
                            : factor == 0 || (product / factor == a.raw && product % factor == 0));
    return narrow(product);
  }
  friend constexpr Fixed operator*(int factor, Fixed a) { return a * factor; }
  constexpr Fixed& operator*=(int factor) { return *this = *this * factor; }

  /// Divided by a whole number, rounded. Stops the program where that is 0.
  friend constexpr Fixed operator/(Fixed a, int divisor) {
    if (divisor > 0) return narrow(raw::round_divide(a.raw, divisor));
    if (divisor == 0) misused("a quantity divided by 0");
    return narrow(raw::subtract(std::int64_t{0}, raw::round_divide(a.raw, -std::int64_t{divisor})));
  }
  constexpr Fixed& operator/=(int divisor) { return *this = *this / divisor; }

  [[nodiscard]] friend constexpr Fixed abs(Fixed x) { return x.raw < 0 ? -x : x; }
  [[nodiscard]] friend constexpr Fixed min(Fixed a, Fixed b) { return a < b ? a : b; }
  [[nodiscard]] friend constexpr Fixed max(Fixed a, Fixed b) { return a < b ? b : a; }
  [[nodiscard]] friend constexpr Fixed clamp(Fixed x, Fixed low, Fixed high) {
    const Fixed raised = x < low ? low : x;
    return raised < high ? raised : high;
  }

 private:
  struct Raw {
    Rep value;
  };
  constexpr explicit Fixed(Raw from) : raw(from.value) {}

  template <std::integral Integer>
  [[nodiscard]] static constexpr bool holds(Integer value) {
    return std::cmp_less_equal(value, std::int64_t{std::numeric_limits<Rep>::max()} >> FracBits) &&
           std::cmp_greater_equal(value, std::int64_t{std::numeric_limits<Rep>::min()} >> FracBits);
  }
  [[nodiscard]] static constexpr bool holds_raw(const raw::Ratio& ratio) {
    return ratio.fits && ratio.value >= std::numeric_limits<Rep>::min() &&
           ratio.value <= std::numeric_limits<Rep>::max();
  }

  [[nodiscard]] static constexpr Fixed narrow(std::int64_t value) {
    LKS_ASSERT(value >= std::numeric_limits<Rep>::min());
    LKS_ASSERT(value <= std::numeric_limits<Rep>::max());
    return from_raw(static_cast<Rep>(value));
  }
};

/// Whether a Fixed is another one by itself.
template <class From, class To>
inline constexpr bool k_widens = false;
template <class D, class R1, int F1, class R2, int F2>
inline constexpr bool k_widens<Fixed<D, R1, F1>, Fixed<D, R2, F2>> =
    HoldsAll<R1, F1, R2, F2> && !std::is_same_v<Fixed<D, R1, F1>, Fixed<D, R2, F2>>;

/// The exact product of two 32-bit quantities.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto operator*(Fixed<D1, std::int32_t, F1> a,
                                       Fixed<D2, std::int32_t, F2> b) {
  return Fixed<DimensionProduct<D1, D2>, std::int64_t, F1 + F2>::from_raw(std::int64_t{a.raw} *
                                                                          b.raw);
}

/// `value` in another format of the same unit, to nearest; must fit.
template <class To, class Rep, int FracBits>
[[nodiscard]] constexpr To rounded(Fixed<typename To::Unit, Rep, FracBits> value) {
  const std::int64_t scaled = raw::scale_binary(value.raw, To::frac_bits - FracBits);
  LKS_ASSERT(scaled >= To::min().raw && scaled <= To::max().raw);
  return To::from_raw(static_cast<typename To::Representation>(scaled));
}

/// As `rounded`, but nothing where it does not fit.
template <class To, class Rep, int FracBits>
[[nodiscard]] constexpr std::optional<To> try_rounded(
    Fixed<typename To::Unit, Rep, FracBits> value) {
  const std::int64_t scaled = raw::scale_saturating(value.raw, To::frac_bits - FracBits);
  if (scaled < To::min().raw || scaled > To::max().raw) return std::nullopt;
  if constexpr (To::frac_bits > FracBits) {
    if (scaled >> (To::frac_bits - FracBits) != value.raw) return std::nullopt;
  }
  return To::from_raw(static_cast<typename To::Representation>(scaled));
}

/// As `rounded`, but a value that does not fit becomes the nearest bound.
template <class To, class Rep, int FracBits>
[[nodiscard]] constexpr To saturated(Fixed<typename To::Unit, Rep, FracBits> value) {
  const std::int64_t scaled = raw::scale_saturating(value.raw, To::frac_bits - FracBits);
  return To::from_raw(raw::saturate<typename To::Representation>(scaled));
}

/// A 64-bit quantity times a 32-bit one, rounded once; the result must fit.
template <class To, class D1, int F1, class D2, int F2>
requires(std::same_as<typename To::Unit, DimensionProduct<D1, D2>>&& F1 + F2 > To::frac_bits)
    [[nodiscard]] constexpr To
    multiply(Fixed<D1, std::int64_t, F1> a, Fixed<D2, std::int32_t, F2> b) {
  const std::int64_t product = raw::multiply_shift(a.raw, b.raw, F1 + F2 - To::frac_bits);
  LKS_ASSERT(product >= To::min().raw && product <= To::max().raw);
  return To::from_raw(static_cast<typename To::Representation>(product));
}

/// A 64-bit quantity times a plain number: the same quantity, rounded once; must fit.
template <class D, int F, int F2>
[[nodiscard]] constexpr Fixed<D, std::int64_t, F> operator*(
    Fixed<D, std::int64_t, F> a, Fixed<Dimension<0, 0, 0>, std::int32_t, F2> factor) {
  return multiply<Fixed<D, std::int64_t, F>>(a, factor);
}
template <class D, int F, int F2>
[[nodiscard]] constexpr Fixed<D, std::int64_t, F> operator*(
    Fixed<Dimension<0, 0, 0>, std::int32_t, F2> factor, Fixed<D, std::int64_t, F> a) {
  return a * factor;
}

/// A quantity of either width times a plain number, in its own format: rounded once, must fit. The
/// operator gives the exact product of two 32-bit quantities instead.
template <class D, class Rep, int F, int F2>
[[nodiscard]] constexpr Fixed<D, Rep, F> scaled(
    Fixed<D, Rep, F> a, Fixed<Dimension<0, 0, 0>, std::int32_t, F2> factor) {
  if constexpr (sizeof(Rep) == 8)
    return a * factor;
  else
    return rounded<Fixed<D, Rep, F>>(a * factor);
}

}  // namespace lockstone
