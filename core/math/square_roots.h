// Reciprocal roots and lengths of typed quantities, correctly rounded. Square roots are in
// <lockstone/roots.h>, the integer roots in core/math/roots.h.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>

#include <lockstone/roots.h>
#include <lockstone/units.h>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {

namespace roots_detail {

template <class R>
[[nodiscard]] constexpr std::uint64_t hypot_raw(R x, R y, R z) {
  const auto square = [](std::int64_t c) { return multiply_wide(magnitude(c), magnitude(c)); };
  return isqrt128_rounded(square(x) + square(y) + square(z));
}

template <>
[[nodiscard]] constexpr std::uint64_t hypot_raw(std::int32_t x, std::int32_t y, std::int32_t z) {
  const auto square = [](std::int64_t c) { return static_cast<std::uint64_t>(c * c); };
  return isqrt_rounded(square(x) + square(y) + square(z));  // at most 3 · 2^62
}

/// 1/√x has two formats: this is 2 · To's bits + x's bits.
template <class To, int F>
inline constexpr int k_rsqrt_scale = 2 * To::frac_bits + F;

}  // namespace roots_detail

/// √(2^scale / size) to nearest, or 2^31 when that is less. 0 < size < 2^32 and 30 ≤ scale ≤ 126,
/// so that no tie exists: (2r + 1)² · size = 2^(scale + 2) has no solution.
[[nodiscard]] constexpr std::uint64_t rsqrt_raw(std::uint64_t size, int scale) {
  constexpr std::uint64_t bound = std::uint64_t{1} << 31;
  LKS_ASSERT(size > 0 && size >> 32 == 0 && scale >= 30 && scale <= 126);
  const int zeros = std::countl_zero(size);
  const int shift = zeros - ((zeros ^ scale) & 1);  // scale + shift is even
  const int drop = 94 - (scale + shift) / 2;
  if (drop < 31) return bound;  // the reciprocal is at least 2^62
  std::uint64_t root = drop > 63 ? 0 : reciprocal_sqrt(size << shift) >> drop;
  if (root >= bound) return bound;
  // The root is the exact floor or one less: step up while root + ½ is not above the exact value.
  const UInt128 limit = UInt128{0, 1} << (scale + 2);
  const auto scaled_square = [size](std::uint64_t odd) { return multiply_wide(odd * odd, size); };
  while (root < bound && scaled_square(2 * root + 1) <= limit)
    ++root;
  return root;
}

/// 1/√x to nearest (there are no ties) in the format To; the maximum of To when it does not fit,
/// and for x ≤ 0.
template <class To, class D, int F>
requires(
    std::same_as<DimensionProduct<D, DimensionSquare<typename To::Unit>>, Dimension<0, 0, 0>> &&
    sizeof(typename To::Representation) == 4) [[nodiscard]] constexpr To
    rsqrt_saturating(Fixed<D, std::int32_t, F> x) {
  if (x.raw <= 0) return To::max();
  const auto size = static_cast<std::uint64_t>(x.raw);
  return roots_detail::bounded<To>(rsqrt_raw(size, roots_detail::k_rsqrt_scale<To, F>));
}

/// 1/√x to nearest in the format To; x > 0, and the result must be below the maximum of To.
template <class To, class D, int F>
[[nodiscard]] constexpr To rsqrt(Fixed<D, std::int32_t, F> x) {
  const To root = rsqrt_saturating<To>(x);
  LKS_ASSERT(x.raw > 0 && root != To::max());
  return root;
}

/// √(x² + y²) and √(x² + y² + z²) to nearest in the arguments' format, or its maximum. Even in each
/// argument and symmetric, exactly.
template <class D, class R, int F>
[[nodiscard]] constexpr Fixed<D, R, F> hypot_saturating(Fixed<D, R, F> x, Fixed<D, R, F> y,
                                                        Fixed<D, R, F> z = {}) {
  return roots_detail::bounded<Fixed<D, R, F>>(roots_detail::hypot_raw(x.raw, y.raw, z.raw));
}

/// As `hypot_saturating`; the result must fit.
template <class D, class R, int F>
[[nodiscard]] constexpr Fixed<D, R, F> hypot(Fixed<D, R, F> x, Fixed<D, R, F> y,
                                             Fixed<D, R, F> z = {}) {
  const std::uint64_t root = roots_detail::hypot_raw(x.raw, y.raw, z.raw);
  LKS_ASSERT((roots_detail::fits<Fixed<D, R, F>>(root)));
  return roots_detail::bounded<Fixed<D, R, F>>(root);
}

}  // namespace lockstone
