// The divisions of the preparation of manifold_block.h for the target at hand.
#if defined(LKS_WIDE_MANIFOLD_DIVIDE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LKS_WIDE_MANIFOLD_DIVIDE_INL_H
#undef LKS_WIDE_MANIFOLD_DIVIDE_INL_H
#else
#define LKS_WIDE_MANIFOLD_DIVIDE_INL_H
#endif

#include "core/kernels/contact/manifold_block.h"
#include "core/kernels/contact/manifold_input_inl.h"
#include "core/kernels/contact/manifold_quotients.h"

HWY_BEFORE_NAMESPACE();
namespace lockstone::lanes {
namespace HWY_NAMESPACE {

/// The divisors of 2^(shift + 30): A of each point, the tangents' determinant.
template <std::size_t count>
struct Divisors {
  Lanes of[count];
};

/// Puts the quotients, rounded down, in the place of their divisors, lane by lane.
template <std::size_t count>
HWY_INLINE HWY_ATTR void divide_each(const PrepareInput* in, Divisors<count>& d) {
  std::int64_t words[count][k_lanes];
  for (std::size_t i = 0; i < count; ++i)
    store(d.of[i], words[i]);
  for (std::size_t lane = 0; lane < k_lanes; ++lane) {
    for (auto& word : words)
      word[lane] = bounded_quotient(in[lane].shift + 30, word[lane], k_one);
  }
  for (std::size_t i = 0; i < count; ++i)
    d.of[i] = load(words[i]);
}

template <int by>
HWY_INLINE HWY_ATTR void raise_below_2_30(Lanes& x, Lanes& lead) {
  const Lanes bound = broadcast(std::int64_t{1} << (31 - by));
  lead = select_less(x, bound, add(lead, broadcast(by)), lead);
  x = select_less(x, bound, shift_left<by>(x), x);
}

/// ⌊2^(shift + 30) / d⌋ for 2^16 ≤ 2^shift ≤ d < 2^31. A line and three of Newton's steps give
/// r ≈ 2^61 / D for D = d · 2^lead from 2^30 to 2^31: less by 1/17 of it, then by (1/17)^8.
/// Truncation makes r less, too: by 3 in all, and so the quotient by 2.
HWY_INLINE HWY_ATTR Lanes quotient_of(Lanes d, Lanes shift, Lanes power) {
  const Lanes none = broadcast(0), one = broadcast(1);
  Lanes high = d, lead = none;
  raise_below_2_30<8>(high, lead);
  raise_below_2_30<4>(high, lead);
  raise_below_2_30<2>(high, lead);
  raise_below_2_30<1>(high, lead);
  Lanes r = subtract(broadcast(k_one * 48 / 17),
                     shift_right<31>(multiply(high, broadcast(k_one * 32 / 17))));
  for (int i = 0; i < 3; ++i) {
    const Lanes factor = subtract(broadcast(INT32_MAX), shift_right<31>(multiply(high, r)));
    r = shift_right<30>(multiply(r, factor));
  }
  const Lanes q = shift_right_each(r, subtract(subtract(broadcast(31), shift), lead));
  const Lanes left = subtract(power, multiply(q, d));
  return add(q, add(select_less(left, d, none, one), select_less(left, add(d, d), none, one)));
}

/// As `divide_each`, side by side where there are lanes enough and divisors as they should be.
template <std::size_t count>
HWY_INLINE HWY_ATTR void divide(const PrepareInput* in, Lanes shift, Divisors<count>& d) {
  const Lanes one = power_of_two(shift);
  Lanes least = d.of[0], most = d.of[0];
  for (std::size_t i = 1; i < count; ++i) {
    least = min(least, d.of[i]);
    most = max(most, d.of[i]);
  }
  if (k_lanes < 4 || any_less(least, one) || any_less(broadcast(INT32_MAX), most))
    return divide_each(in, d);
  for (Lanes& each : d.of)
    each = quotient_of(each, shift, shift_left<30>(one));
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
HWY_AFTER_NAMESPACE();

#endif  // the guard
