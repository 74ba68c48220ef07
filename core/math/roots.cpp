#include "core/math/roots.h"

#include <cstddef>

#include <lockstone/roots.h>

namespace lockstone {
namespace {

template <std::size_t N>
using Raws = std::array<std::uint64_t, N>;

/// 1 / √(sum of squares) = reciprocal · 2^-exponent.
struct ReciprocalNorm {
  std::uint64_t reciprocal = 0;
  int exponent = 0;
};

ReciprocalNorm reciprocal_norm(UInt128 sum_of_squares) {
  const int shift = countl_zero(sum_of_squares) & ~1;
  return {reciprocal_sqrt((sum_of_squares << shift).high), 126 - shift / 2};
}

// The sum stays in 64 bits while every component fits in 31 bits, and N ≤ 4.
template <std::size_t N>
UInt128 sum_of_squares(const Raws<N>& sizes, std::uint64_t all_bits) {
  UInt128 sum;
  if ((all_bits >> 31) == 0) {
    for (const std::uint64_t a : sizes)
      sum.low += a * a;
  } else {
    for (const std::uint64_t a : sizes)
      sum = sum + multiply_wide(a, a);
  }
  return sum;
}

/// |component| / norm with 30 fraction bits, to nearest.
std::uint64_t unit_component(std::uint64_t size, int left_shift, ReciprocalNorm norm) {
  const int right_shift = left_shift + norm.exponent - 64 - 30;  // 32 or 33
  const std::uint64_t high = multiply_high(size << left_shift, norm.reciprocal);
  return (high + (std::uint64_t{1} << (right_shift - 1))) >> right_shift;
}

Unit with_sign_of(std::int64_t sign, std::uint64_t size) {
  const auto value = static_cast<std::int32_t>(size);
  return Unit::from_raw(sign < 0 ? -value : value);
}

template <std::size_t N>
struct Normal {
  std::array<Unit, N> unit{};
  UInt128 squares;
};

template <std::size_t N>
Normal<N> normalise(const std::array<std::int64_t, N>& components) {
  Raws<N> sizes{};
  std::uint64_t all_bits = 0;
  for (std::size_t i = 0; i < N; ++i) {
    sizes[i] = magnitude(components[i]);
    all_bits |= sizes[i];
  }
  Normal<N> result;
  if (all_bits == 0) return result;
  result.squares = sum_of_squares(sizes, all_bits);
  const ReciprocalNorm norm = reciprocal_norm(result.squares);
  const int left_shift = std::countl_zero(all_bits);
  for (std::size_t i = 0; i < N; ++i) {
    result.unit[i] = with_sign_of(components[i], unit_component(sizes[i], left_shift, norm));
  }
  return result;
}

}  // namespace

std::uint64_t roots_detail::root_of(std::int64_t raw, int shift) {
  LKS_ASSERT(shift >= 0 && shift <= 63);
  if (raw <= 0) return 0;
  const auto size = static_cast<std::uint64_t>(raw);
  if (shift <= std::countl_zero(size)) return isqrt_rounded(size << shift);
  return isqrt128_rounded(UInt128{0, size} << shift);
}

std::uint64_t norm(std::int64_t x, std::int64_t y, std::int64_t z) {
  const Raws<3> sizes{magnitude(x), magnitude(y), magnitude(z)};
  return isqrt128_rounded(sum_of_squares(sizes, sizes[0] | sizes[1] | sizes[2]));
}

Vec3<Unit> direction_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  const Normal<3> normal = normalise<3>({x, y, z});
  return {normal.unit[0], normal.unit[1], normal.unit[2]};
}

Quat direction_of(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t w) {
  if ((x | y | z | w) == 0) return {};
  const Normal<4> normal = normalise<4>({x, y, z, w});
  return {normal.unit[0], normal.unit[1], normal.unit[2], normal.unit[3]};
}

Direction direction(std::int64_t x, std::int64_t y, std::int64_t z) {
  const Normal<3> normal = normalise<3>({x, y, z});
  return {{normal.unit[0], normal.unit[1], normal.unit[2]}, isqrt128_rounded(normal.squares)};
}

Quat normalized(const Quat& q) {
  const std::uint64_t square = norm_squared(q);
  if (is_near_unit(square)) {
    const std::int64_t correction = unit_correction(square);
    const auto scaled = [correction](Unit c) {
      const std::int64_t change = raw::round_shift(c.raw * correction, 51);
      return Unit::from_raw(static_cast<std::int32_t>(c.raw + change));
    };
    return {scaled(q.x), scaled(q.y), scaled(q.z), scaled(q.w)};
  }
  return direction_of(q.x.raw, q.y.raw, q.z.raw, q.w.raw);
}

}  // namespace lockstone
