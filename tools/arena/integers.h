// Integer helpers of the game: random numbers, square root, headings. No floating point: all of
// this is computed alike by every peer.
#pragma once

#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::arena {

/// A bijective scramble of 64 bits. Source: Sebastiano Vigna, "splitmix64", public domain.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

/// A sequence of numbers whose whole state is one word, so that a game can save it.
///
/// Draw one number a statement: in f(random.next(), random.next()) the compiler chooses which comes
/// first, and peers built by different compilers part.
class Random {
 public:
  explicit constexpr Random(std::uint64_t state) : state_(state) {}

  constexpr std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return mix(state_);
  }

  /// 0 … bound − 1; bound > 0.
  constexpr std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
  }

  /// low … high, both included.
  constexpr std::int32_t between(std::int32_t low, std::int32_t high) {
    return low + static_cast<std::int32_t>(below(static_cast<std::uint32_t>(high - low + 1)));
  }

  [[nodiscard]] constexpr std::uint64_t state() const { return state_; }

 private:
  std::uint64_t state_;
};

/// The largest integer whose square is at most `value`.
[[nodiscard]] constexpr std::uint32_t integer_sqrt(std::uint64_t value) {
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 31; bit != 0; bit >>= 1) {
    const std::uint64_t trial = root | bit;
    if (trial * trial <= value) root = trial;
  }
  return static_cast<std::uint32_t>(root);
}

[[nodiscard]] constexpr Position millimetres(std::int64_t value) {
  return Position::from_ratio(value, 1000);
}
[[nodiscard]] constexpr Length millimetres_long(std::int64_t value) {
  return Length::from_ratio(value, 1000);
}

/// A heading in 1/65536 turns: 0 looks along +x, a quarter turn along +z. The unit vector, error
/// below 1e-8.
[[nodiscard]] Vec3<Unit> direction_of(std::int16_t yaw);

/// The heading of (x, z), within 0.3°; 0 for no direction. |x|, |z| < 2^40.
[[nodiscard]] std::int16_t yaw_of(std::int64_t x, std::int64_t z);

}  // namespace lockstone::arena
