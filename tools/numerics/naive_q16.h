// A plain Q16.16 class: 32-bit raws, truncating products, short polynomials, one format
// for everything. The yardstick of `lockstone bench numerics`, not used anywhere else.
#pragma once

#include <bit>
#include <cstdint>

namespace lockstone::numerics {

struct NaiveQ16 {
  std::int32_t raw = 0;

  static constexpr std::int32_t k_one = 1 << 16;
  static constexpr std::int32_t k_pi = 205887;
  static constexpr std::int32_t k_half_pi = 102944;

  friend constexpr NaiveQ16 operator+(NaiveQ16 a, NaiveQ16 b) { return {a.raw + b.raw}; }
  friend constexpr NaiveQ16 operator-(NaiveQ16 a, NaiveQ16 b) { return {a.raw - b.raw}; }
  friend constexpr NaiveQ16 operator*(NaiveQ16 a, NaiveQ16 b) {
    return {static_cast<std::int32_t>((std::int64_t{a.raw} * b.raw) >> 16)};
  }
  friend constexpr NaiveQ16 operator/(NaiveQ16 a, NaiveQ16 b) {
    return {b.raw == 0 ? 0 : static_cast<std::int32_t>((std::int64_t{a.raw} * k_one) / b.raw)};
  }
  constexpr NaiveQ16 operator-() const { return {-raw}; }
};

/// Bit by bit.
constexpr NaiveQ16 sqrt(NaiveQ16 x) {
  const auto n = static_cast<std::uint64_t>(x.raw < 0 ? 0 : x.raw) << 16;
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 23; bit != 0; bit >>= 1) {
    const std::uint64_t candidate = root | bit;
    if (candidate * candidate <= n) root = candidate;
  }
  return {static_cast<std::int32_t>(root)};
}

/// x − x³/6 + x⁵/120 − x⁷/5040 on the quarter turn.
constexpr NaiveQ16 sin(NaiveQ16 x) {
  std::int32_t r = x.raw % (2 * NaiveQ16::k_pi);
  if (r > NaiveQ16::k_pi) r -= 2 * NaiveQ16::k_pi;
  if (r < -NaiveQ16::k_pi) r += 2 * NaiveQ16::k_pi;
  if (r > NaiveQ16::k_half_pi) r = NaiveQ16::k_pi - r;
  if (r < -NaiveQ16::k_half_pi) r = -NaiveQ16::k_pi - r;
  const NaiveQ16 a{r}, z = a * a;
  return a - a * z * (NaiveQ16{10923} - z * (NaiveQ16{546} - z * NaiveQ16{13}));
}

constexpr NaiveQ16 cos(NaiveQ16 x) {
  return sin(x + NaiveQ16{NaiveQ16::k_half_pi});
}

constexpr NaiveQ16 tan(NaiveQ16 x) {
  return sin(x) / cos(x);
}

/// Abramowitz and Stegun, 4.4.49, on [0, 1].
constexpr NaiveQ16 atan_of_fraction(NaiveQ16 x) {
  const NaiveQ16 z = x * x;
  const NaiveQ16 p = NaiveQ16{11797} + z * (NaiveQ16{-5579} + z * NaiveQ16{1365});
  return x * (NaiveQ16{65527} + z * (NaiveQ16{-21646} + z * p));
}

constexpr NaiveQ16 atan2(NaiveQ16 y, NaiveQ16 x) {
  const NaiveQ16 ax{x.raw < 0 ? -x.raw : x.raw}, ay{y.raw < 0 ? -y.raw : y.raw};
  if (ax.raw == 0 && ay.raw == 0) return {};
  NaiveQ16 angle = ay.raw <= ax.raw ? atan_of_fraction(ay / ax)
                                    : NaiveQ16{NaiveQ16::k_half_pi} - atan_of_fraction(ax / ay);
  if (x.raw < 0) angle = NaiveQ16{NaiveQ16::k_pi} - angle;
  return y.raw < 0 ? -angle : angle;
}

constexpr NaiveQ16 atan(NaiveQ16 x) {
  return atan2(x, {NaiveQ16::k_one});
}

constexpr NaiveQ16 asin(NaiveQ16 x) {
  return atan2(x, sqrt(NaiveQ16{NaiveQ16::k_one} - x * x));
}

constexpr NaiveQ16 acos(NaiveQ16 x) {
  return NaiveQ16{NaiveQ16::k_half_pi} - asin(x);
}

/// 1 + f·(0.6951 + f·(0.2276 + f·0.0773)) times the whole power.
constexpr NaiveQ16 exp2(NaiveQ16 x) {
  const std::int32_t whole = x.raw >> 16;
  const NaiveQ16 f{x.raw & 0xffff};
  const NaiveQ16 p = NaiveQ16{NaiveQ16::k_one} +
                     f * (NaiveQ16{45555} + f * (NaiveQ16{14916} + f * NaiveQ16{5065}));
  return {whole >= 0 ? p.raw << (whole > 14 ? 14 : whole) : p.raw >> (whole < -31 ? 31 : -whole)};
}

/// One bit a squaring.
constexpr NaiveQ16 log2(NaiveQ16 x) {
  if (x.raw <= 0) return {INT32_MIN};
  const auto size = static_cast<std::uint32_t>(x.raw);
  const int whole = 15 - std::countl_zero(size);
  std::uint64_t m = std::uint64_t{size} << (31 - (whole + 16));
  std::int32_t result = whole;
  for (int i = 0; i < 16; ++i) {
    m = (m * m) >> 31;
    const bool bit = (m >> 32) != 0;
    if (bit) m >>= 1;
    result = result * 2 + (bit ? 1 : 0);
  }
  return {result};
}

constexpr NaiveQ16 hypot(NaiveQ16 x, NaiveQ16 y) {
  return sqrt(x * x + y * y);
}

}  // namespace lockstone::numerics
