#include "core/math/factorial.h"
#include "core/math/int128.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

// ⌊2^101 / π⌋ in two words and ⌊π · 2^62⌉: π = 3.243f6a8885a308d3…, hexadecimal.
constexpr std::uint64_t k_inverse_half_turn_high = 0xa2f9836e4U;
constexpr std::uint64_t k_inverse_half_turn_low = 0xe441529fc2757d1fU;
constexpr std::uint64_t k_pi_q62 = 0xc90fdaa22168c235U;

/// 1/first! − z/(first + 2)! + z²/(first + 4)! − … ± z^k/last!, 64 fraction bits.
template <int First, int Last>
constexpr std::uint64_t alternating_series(std::uint64_t z) {
  std::uint64_t sum = inverse_factorial_q64(Last);
  for (int n = Last - 2; n >= First; n -= 2)
    sum = inverse_factorial_q64(n) - multiply_high(z, sum);
  return sum;
}

/// Sine and cosine with 63 fraction bits, of 0 ≤ r ≤ π/4 with 63; errors below 2^-60.
struct LongSinCos {
  std::uint64_t sin = 0;
  std::uint64_t cos = 0;
};

constexpr LongSinCos long_sin_cos(std::uint64_t r) {
  const std::uint64_t z = multiply_high(2 * r, 2 * r);  // r², 64 fraction bits
  const std::uint64_t cube = multiply_high(multiply_high(z, r), alternating_series<3, 19>(z));
  const std::uint64_t fourth = multiply_high(multiply_high(z, z), alternating_series<4, 18>(z));
  return {r - cube, (std::uint64_t{1} << 63) - (z >> 2) + (fourth >> 1)};
}

}  // namespace

std::int32_t tan_raw_saturating(Angle x, int result_bits) {
  LKS_ASSERT(result_bits >= 0 && result_bits <= 31);
  // The fraction of a half turn, as the reduction for sines takes it of a turn.
  const std::uint64_t size = magnitude(x.raw);
  const UInt128 product = multiply_wide(size, k_inverse_half_turn_low);
  const std::uint64_t half_turns = product.high + size * k_inverse_half_turn_high;
  const std::uint64_t quadrant = (half_turns + (std::uint64_t{1} << 62)) >> 63;
  const auto rest = static_cast<std::int64_t>(half_turns - (quadrant << 63));
  const LongSinCos octant = long_sin_cos(multiply_high(2 * magnitude(rest), k_pi_q62));
  const bool inverted = quadrant != 0;  // tan(π/2 + r) = −1/tan r
  const UInt128 top = UInt128{0, inverted ? octant.cos : octant.sin} << result_bits;
  const std::uint64_t bottom = inverted ? octant.sin : octant.cos;
  std::uint64_t result = 0x7fffffff;
  if (top < (UInt128{0, bottom} << 31)) {
    const std::uint64_t quotient = round_divide(top, bottom);
    if (quotient < result) result = quotient;
  }
  const auto value = static_cast<std::int32_t>(result);
  return ((x.raw < 0) != (rest < 0)) != inverted ? -value : value;
}

}  // namespace lockstone
