// Every lane operation of a target behind one signature, for comparison with its scalar twin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace lockstone::lanes::test {

/// As many lanes as any target has.
inline constexpr std::size_t k_most_lanes = 8;
using Values = std::array<std::int64_t, k_most_lanes>;

/// Operands of the operations. shift is 1 … 32 and half is 2^(shift − 1); far is 1 … 62 and
/// far_half is 2^(far − 1).
struct Operands {
  Values a{}, b{}, c{}, shift{}, half{}, far{}, far_half{};
};

inline constexpr std::uint64_t k_all_bits = ~std::uint64_t{0};
inline constexpr std::uint64_t k_low_bits = 0xffffffffU;

// name, with lanes, with one lane, the bits that count. Both sides see a, b, c and the shifts.
// clang-format off
#define LKS_LANE_OPERATIONS(X)                                                                    \
  X(broadcast, broadcast(-5), Lane{-5}, k_all_bits)                                               \
  X(add, add(a, b), add(a, b), k_all_bits)                                                        \
  X(subtract, subtract(a, b), subtract(a, b), k_all_bits)                                         \
  X(upper, upper(a), high(a), k_low_bits)                                                         \
  X(pack, pack(a, b), pack(a, b), k_all_bits)                                                     \
  X(with_upper_of, with_upper_of(a, b), pack(a, high(b)), k_all_bits)                             \
  X(lower_part, lower_part(a), low_part(a), k_all_bits)                                           \
  X(upper_part, upper_part(a), high_part(a), k_all_bits)                                          \
  X(low_byte, low_byte(a), low_byte(a), k_all_bits)                                               \
  X(left_15, shift_left<15>(a), shift_left(a, 15), k_all_bits)                                    \
  X(right_31, shift_right<31>(a), shift_right(a, 31), k_all_bits)                                 \
  X(right_each, shift_right_each(a, shift), shift_right(a, static_cast<int>(shift)), k_all_bits)  \
  X(power_of_two, power_of_two(shift), power_of_two(shift), k_all_bits)       \
  X(multiple_18, round_to_multiple<18>(a), round_to_multiple(a, 18), k_all_bits)                  \
  X(at_most, at_most(a, 12345678), at_most(a, 12345678), k_all_bits)                              \
  X(multiply, multiply(a, b), multiply(a, b), k_all_bits)                                         \
  X(multiply_upper, multiply(upper(a), b), multiply(high(a), b), k_all_bits)                      \
  X(multiply_add, multiply_add(a, b, c), multiply_add(a, b, c), k_all_bits)                       \
  X(multiply_subtract, multiply_subtract(a, b, c), multiply_subtract(a, b, c), k_all_bits)        \
  X(round_1, round_shift_low<1>(a), round_shift_low(a, 1), k_all_bits)                            \
  X(round_20, round_shift_low<20>(a), round_shift_low(a, 20), k_all_bits)                         \
  X(round_30, round_shift_low<30>(a), round_shift_low(a, 30), k_all_bits)                         \
  X(round_32, round_shift_low<32>(a), round_shift_low(a, 32), k_all_bits)                         \
  X(round_37, round_shift_far<37>(a), round_shift_far(a, 37), 0xffffffffU)                        \
  X(round_each, round_shift_low(a, shift, half), round_shift_low(a, static_cast<int>(shift)),     \
    k_all_bits)                                                                                   \
  X(whole_1, round_shift<1>(a), round_shift(a, 1), k_all_bits)                                    \
  X(whole_10, round_shift<10>(a), round_shift(a, 10), k_all_bits)                                 \
  X(whole_30, round_shift<30>(a), round_shift(a, 30), k_all_bits)                                 \
  X(whole_62, round_shift<62>(a), round_shift(a, 62), k_all_bits)                                 \
  X(whole_each, round_shift(a, far, far_half), round_shift(a, static_cast<int>(far)), k_all_bits) \
  X(unsigned_4, round_shift_unsigned<4>(a), round_shift_unsigned(a, 4), k_all_bits)               \
  X(positive_20, round_shift_positive<20>(a, INT32_MAX),                                          \
    round_shift_positive(a, 20, INT32_MAX), k_all_bits)                                           \
  X(positive_30, round_shift_positive<30>(a, 12345678),                                           \
    round_shift_positive(a, 30, 12345678), k_all_bits)                                            \
  X(dot, round_shift_low<30>(multiply_add(multiply_add(multiply(a, b), b, c), c, a)),             \
    round_shift_low(multiply_add(multiply_add(multiply(a, b), b, c), c, a), 30), k_all_bits)      \
  X(bit_and, bit_and(a, b), bit_and(a, b), k_all_bits)                                            \
  X(bit_or, bit_or(a, b), bit_or(a, b), k_all_bits)                                               \
  X(bit_and_not, bit_and_not(a, b), bit_and_not(a, b), k_all_bits)                                \
  X(without_sign, without_sign(a), without_sign(a), k_all_bits)                                   \
  X(min, min(a, b), min(a, b), k_all_bits)                                                        \
  X(max, max(a, b), max(a, b), k_all_bits)                                                        \
  X(clamp, clamp(a, min(b, c), max(b, c)), clamp(a, min(b, c), max(b, c)), k_all_bits)            \
  X(saturate, saturate(a), saturate(a), k_all_bits)                                               \
  X(select_less, select_less(a, b, b, c), select_less(a, b, b, c), k_all_bits)                    \
  X(select_equal, select_equal(a, b, c, a), select_equal(a, b, c, a), k_all_bits)
// clang-format on

#define LKS_LANE_NAME(name, ...) name,
enum class Operation { LKS_LANE_OPERATIONS(LKS_LANE_NAME) count };
#undef LKS_LANE_NAME

/// The lanes beyond those of the target are left alone.
struct TargetOperations {
  std::string_view target;
  std::size_t lanes;
  void (*compute)(Operation operation, const Operands& in, Values& out);

  // Over all lanes: whether a < b in any, and a bit for each where it is.
  bool (*any_less)(const Operands& in);
  std::uint32_t (*bits_of_less)(const Operands& in);

  // Indices for the words of a table, all different.
  void (*gather_64)(const std::int64_t* base, const std::int64_t* index, Values& out);
  void (*scatter_64)(const Values& x, std::int64_t* base, const std::int64_t* index);
  void (*gather_32)(const std::int32_t* base, const std::int32_t* index, Values& out);
  void (*scatter_32)(const Values& x, std::int32_t* base, const std::int32_t* index);

  // Four words of each lane's record, which begins at base + index · stride.
  void (*load_four)(const std::int64_t* base, const std::uint32_t* index, std::size_t stride,
                    Values (&out)[4]);
  void (*store_four)(const Values (&x)[4], std::int64_t* base, const std::uint32_t* index,
                     std::size_t stride);
};

/// The operations in this build; the processor may lack some.
[[nodiscard]] std::span<const TargetOperations> compiled_operations();

[[nodiscard]] std::string_view name_of(Operation operation);

}  // namespace lockstone::lanes::test
