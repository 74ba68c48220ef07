// Lanes of one word, by plain integers: with them a kernel's source also compiles to its scalar
// twin. Each operation is that of scalar_lanes.h, under its name in lanes_inl.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/math/wide/scalar_lanes.h"

// Highway's macros, defined for plain code.
#define HWY_NAMESPACE N_SCALAR_TWIN
#define HWY_ATTR
#define HWY_INLINE inline
#define HWY_BEFORE_NAMESPACE() static_assert(true, "plain code")
#define HWY_AFTER_NAMESPACE() static_assert(true, "plain code")

namespace lockstone::lanes {
namespace HWY_NAMESPACE {

using Lanes = std::int64_t;
inline constexpr std::size_t k_lanes = 1;

using scalar::add;
using scalar::any_less;
using scalar::bit_and;
using scalar::bit_and_not;
using scalar::bit_or;
using scalar::bits_of_less;
using scalar::clamp;
using scalar::max;
using scalar::min;
using scalar::multiply;
using scalar::multiply_add;
using scalar::multiply_subtract;
using scalar::pack;
using scalar::power_of_two;
using scalar::saturate;
using scalar::select_equal;
using scalar::select_less;
using scalar::subtract;
using scalar::with_upper_of;
using scalar::without_sign;

inline Lanes load(const std::int64_t* from) {
  return *from;
}
inline Lanes load_upper(const std::int64_t* from) {
  return scalar::high(*from);
}
inline void store(Lanes x, std::int64_t* to) {
  *to = x;
}
inline Lanes broadcast(std::int64_t x) {
  return x;
}
inline Lanes upper(Lanes x) {
  return scalar::high(x);
}
inline Lanes lower_part(Lanes x) {
  return scalar::low_part(x);
}
inline Lanes upper_part(Lanes x) {
  return scalar::high_part(x);
}
inline Lanes low_byte(Lanes x) {
  return scalar::low_byte(x);
}
template <int shift>
Lanes shift_left(Lanes x) {
  return scalar::shift_left(x, shift);
}
template <int shift>
Lanes shift_right(Lanes x) {
  return scalar::shift_right(x, shift);
}
inline Lanes shift_right_each(Lanes x, Lanes shift) {
  return scalar::shift_right(x, static_cast<int>(shift));
}
template <int shift>
Lanes round_shift_low(Lanes x) {
  return scalar::round_shift_low(x, shift);
}
inline Lanes round_shift_low(Lanes x, Lanes shift, Lanes) {
  return scalar::round_shift_low(x, static_cast<int>(shift));
}
template <int shift>
Lanes round_shift_far(Lanes x) {
  return scalar::round_shift_far(x, shift);
}
template <int shift>
Lanes round_shift(Lanes x) {
  return scalar::round_shift(x, shift);
}
inline Lanes round_shift(Lanes x, Lanes shift, Lanes) {
  return scalar::round_shift(x, static_cast<int>(shift));
}
template <int shift>
Lanes round_shift_unsigned(Lanes x) {
  return scalar::round_shift_unsigned(x, shift);
}
template <int shift>
Lanes round_shift_positive(Lanes x, std::int32_t bound) {
  return scalar::round_shift_positive(x, shift, bound);
}
template <int bits>
Lanes round_to_multiple(Lanes x) {
  return scalar::round_to_multiple(x, bits);
}
inline Lanes at_most(Lanes x, std::int32_t bound) {
  return scalar::at_most(x, bound);
}

template <class Word>
struct RecordsAt {
  Word* base;
  const std::uint32_t* index;
  std::size_t stride;

  Word* operator()(std::size_t lane) const { return base + index[lane] * stride; }
};

inline void load_words(const std::int64_t* from, Lanes& first, Lanes& second) {
  first = from[0];
  second = from[1];
}
inline void load_words(const std::int32_t* from, Lanes& first, Lanes& second) {
  first = scalar::pack(from[0], from[1]);
  second = scalar::pack(from[2], from[3]);
}
template <class At>
void load_two(const At& at, Lanes& first, Lanes& second) {
  load_words(at(0), first, second);
}
inline void store_words(Lanes first, Lanes second, std::int64_t* to) {
  to[0] = first;
  to[1] = second;
}
inline void store_words(Lanes first, Lanes second, std::int32_t* to) {
  to[0] = scalar::low(first);
  to[1] = scalar::high(first);
  to[2] = scalar::low(second);
  to[3] = scalar::high(second);
}
template <class At>
void store_two(Lanes first, Lanes second, const At& at) {
  store_words(first, second, at(0));
}

}  // namespace HWY_NAMESPACE
}  // namespace lockstone::lanes
