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
#include <cstdint>
#include <limits>

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

/// One quantity: unit, representation and binary point. Plain data; zero by default.
template <class Dim, std::signed_integral Rep, int FracBits>
struct Fixed {
  using Unit = Dim;
  using Representation = Rep;
  static constexpr int frac_bits = FracBits;

  Rep raw = 0;

  [[nodiscard]] static constexpr Fixed from_raw(Rep value) { return Fixed{value}; }

  /// `value` whole units; must fit.
  [[nodiscard]] static constexpr Fixed from_integer(std::int64_t value) {
    return narrow(raw::scale_binary(value, FracBits));
  }

  /// numerator / denominator units, correctly rounded. |numerator| < 2^(62 − FracBits).
  [[nodiscard]] static constexpr Fixed from_ratio(std::int64_t numerator,
                                                  std::int64_t denominator) {
    return narrow(raw::round_divide(raw::scale_binary(numerator, FracBits), denominator));
  }

  [[nodiscard]] static constexpr Fixed max() { return {std::numeric_limits<Rep>::max()}; }
  [[nodiscard]] static constexpr Fixed min() { return {std::numeric_limits<Rep>::min()}; }

  friend constexpr auto operator<=>(Fixed, Fixed) = default;

  friend constexpr Fixed operator+(Fixed a, Fixed b) { return {raw::add(a.raw, b.raw)}; }
  friend constexpr Fixed operator-(Fixed a, Fixed b) { return {raw::subtract(a.raw, b.raw)}; }
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

  /// Divided by a positive whole number, rounded.
  friend constexpr Fixed operator/(Fixed a, int divisor) {
    return narrow(raw::round_divide(a.raw, divisor));
  }

 private:
  [[nodiscard]] static constexpr Fixed narrow(std::int64_t value) {
    LKS_ASSERT(value >= std::numeric_limits<Rep>::min());
    LKS_ASSERT(value <= std::numeric_limits<Rep>::max());
    return {static_cast<Rep>(value)};
  }
};

/// The exact product of two 32-bit quantities.
template <class D1, int F1, class D2, int F2>
[[nodiscard]] constexpr auto operator*(Fixed<D1, std::int32_t, F1> a,
                                       Fixed<D2, std::int32_t, F2> b) {
  return Fixed<DimensionProduct<D1, D2>, std::int64_t, F1 + F2>{std::int64_t{a.raw} * b.raw};
}

/// `value` in another format of the same unit, to nearest; must fit.
template <class To, class Rep, int FracBits>
[[nodiscard]] constexpr To rounded(Fixed<typename To::Unit, Rep, FracBits> value) {
  const std::int64_t scaled = raw::scale_binary(value.raw, To::frac_bits - FracBits);
  LKS_ASSERT(scaled >= To::min().raw && scaled <= To::max().raw);
  return To{static_cast<typename To::Representation>(scaled)};
}

/// As `rounded` to a coarser or equal format, but what does not fit becomes the nearest bound.
template <class To, class Rep, int FracBits>
requires(FracBits >= To::frac_bits) [[nodiscard]] constexpr To
    saturated(Fixed<typename To::Unit, Rep, FracBits> value) {
  const std::int64_t scaled = raw::round_shift_any(value.raw, FracBits - To::frac_bits);
  return To{raw::saturate<typename To::Representation>(scaled)};
}

/// A 64-bit quantity times a 32-bit one, rounded once; the result must fit.
template <class To, class D1, int F1, class D2, int F2>
requires(std::same_as<typename To::Unit, DimensionProduct<D1, D2>>&& F1 + F2 > To::frac_bits)
    [[nodiscard]] constexpr To
    multiply(Fixed<D1, std::int64_t, F1> a, Fixed<D2, std::int32_t, F2> b) {
  const std::int64_t product = raw::multiply_shift(a.raw, b.raw, F1 + F2 - To::frac_bits);
  LKS_ASSERT(product >= To::min().raw && product <= To::max().raw);
  return To{static_cast<typename To::Representation>(product)};
}

template <class D, class R, int F>
[[nodiscard]] constexpr Fixed<D, R, F> abs(Fixed<D, R, F> x) {
  return x.raw < 0 ? -x : x;
}

template <class D, class R, int F>
[[nodiscard]] constexpr Fixed<D, R, F> min(Fixed<D, R, F> a, Fixed<D, R, F> b) {
  return a < b ? a : b;
}

template <class D, class R, int F>
[[nodiscard]] constexpr Fixed<D, R, F> max(Fixed<D, R, F> a, Fixed<D, R, F> b) {
  return a < b ? b : a;
}

template <class D, class R, int F>
[[nodiscard]] constexpr Fixed<D, R, F> clamp(Fixed<D, R, F> x, Fixed<D, R, F> low,
                                             Fixed<D, R, F> high) {
  return min(max(x, low), high);
}

}  // namespace lockstone
