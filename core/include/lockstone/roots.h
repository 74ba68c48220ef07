// Square roots of quantities. The length of a vector is in vector_math.h.
#pragma once

#include <concepts>
#include <cstdint>

#include <lockstone/units.h>

namespace lockstone {

template <class D>
using DimensionSquare = DimensionProduct<D, D>;

namespace roots_detail {

template <class To>
[[nodiscard]] constexpr bool fits(std::uint64_t root) {
  return root <= static_cast<std::uint64_t>(To::max().raw);
}

/// To{root}, or its maximum.
template <class To>
[[nodiscard]] constexpr To bounded(std::uint64_t root) {
  return fits<To>(root) ? To::from_raw(static_cast<typename To::Representation>(root)) : To::max();
}

/// √(raw · 2^shift) to nearest, 0 for negative numbers. 0 ≤ shift ≤ 63.
[[nodiscard]] std::uint64_t root_of(std::int64_t raw, int shift);

/// The raw of √x in the format To, wide enough for every x.
template <class To, class D, class R, int F>
[[nodiscard]] std::uint64_t root_raw(Fixed<D, R, F> x) {
  constexpr int shift = 2 * To::frac_bits - F;  // root² = raw · 2^shift
  static_assert(shift >= 0 && shift <= 63);
  return root_of(x.raw, shift);
}

}  // namespace roots_detail

/// √x to nearest (there are no ties) in the format To, whose unit squared is x's:
/// sqrt_saturating<Length>(dot(v, v)). The maximum of To when it does not fit; negative x gives 0.
template <class To, class D, class R, int F>
requires(std::same_as<D, DimensionSquare<typename To::Unit>>) [[nodiscard]] To
    sqrt_saturating(Fixed<D, R, F> x) {
  return roots_detail::bounded<To>(roots_detail::root_raw<To>(x));
}

/// √x to nearest in the format To; x ≥ 0, and the result must fit.
template <class To, class D, class R, int F>
requires(std::same_as<D, DimensionSquare<typename To::Unit>>) [[nodiscard]] To
    sqrt(Fixed<D, R, F> x) {
  const std::uint64_t root = roots_detail::root_raw<To>(x);
  LKS_ASSERT(x.raw >= 0 && roots_detail::fits<To>(root));
  return roots_detail::bounded<To>(root);
}

/// √x of a plain number in its own format; x ≥ 0.
template <class R, int F>
[[nodiscard]] auto sqrt(Fixed<Scalar, R, F> x) {
  return sqrt<Fixed<Scalar, R, F>>(x);
}

}  // namespace lockstone
