#include "core/math/square_roots.h"
#include "tools/numerics/vector_parts.h"

namespace lockstone::numerics {
namespace {

/// From the upper three quarters of all words, where the kernel is defined.
void raise_to_kernel(Words& in) {
  if (u64(in[0]) >> 62 == 0) in[0] ^= std::int64_t{1} << 62;
}

/// The rounded root must fit in 64 bits.
void lower_top(Words& in) {
  if (u64(in[0]) > ~std::uint64_t{1}) in[0] = -2;
}

}  // namespace

std::vector<Function> root_functions() {
  using W = const Words&;
  return {
      {"reciprocal_sqrt",
       {k_any64},
       [](W in) -> Words { return {i64(reciprocal_sqrt(u64(in[0])))}; },
       raise_to_kernel},
      {"isqrt", {k_any64}, [](W in) -> Words { return {isqrt(u64(in[0]))}; }},
      {"isqrt_rounded", {k_any64}, [](W in) -> Words { return {i64(isqrt_rounded(u64(in[0])))}; }},
      {"isqrt128",
       {k_any64, k_any64},
       [](W in) -> Words {
         return {i64(isqrt128({u64(in[0]), u64(in[1])}))};
       }},
      {"isqrt128_rounded",
       {k_any64, k_any64},
       [](W in) -> Words {
         return {i64(isqrt128_rounded({u64(in[0]), u64(in[1])}))};
       },
       lower_top},
      {"norm",
       {k_any64, k_any64, k_any64},
       [](W in) -> Words { return {i64(norm(in[0], in[1], in[2]))}; }},
      {"length",
       {k_any32, k_any32, k_any32},
       [](W in) -> Words { return {length(vec3_at<Length>(in, 0)).raw}; }},
      {"direction_of",
       {k_any64, k_any64, k_any64},
       [](W in) -> Words { return words(direction_of(in[0], in[1], in[2])); }},
      {"normalized",
       {k_any32, k_any32, k_any32, k_any32},
       [](W in) -> Words { return words(normalized(quat_at(in, 0))); }},
      {"sqrt_q20",
       {{0, k_max32}},
       [](W in) -> Words { return {sqrt(Number::from_raw(i32(in[0]))).raw}; }},
      {"sqrt_q30",
       {{0, k_max32}},
       [](W in) -> Words { return {sqrt(Unit::from_raw(i32(in[0]))).raw}; }},
      {"rsqrt",
       {{1, 0xffffffff}, {30, 126}},
       [](W in) -> Words { return {i64(rsqrt_raw(u64(in[0]), i32(in[1])))}; }},
      {"hypot",
       {k_any32, k_any32, k_any32},
       [](W in) -> Words {
         return {hypot_saturating(Length::from_raw(i32(in[0])), Length::from_raw(i32(in[1])),
                                  Length::from_raw(i32(in[2])))
                     .raw};
       }},
      {"hypot_wide",
       {k_any64, k_any64, k_any64},
       [](W in) -> Words {
         return {hypot_saturating(Position::from_raw(in[0]), Position::from_raw(in[1]),
                                  Position::from_raw(in[2]))
                     .raw};
       }},
  };
}

}  // namespace lockstone::numerics
