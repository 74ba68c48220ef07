// Random numbers for the game's own rules: the same on every peer, and a state of two words.
//
// The generator is Philox4x32-10: John Salmon, Mark Moraes, Ron Dror, David Shaw, "Parallel random
// numbers: as easy as 1, 2, 3", SC 2011. It scrambles a counter with a key, so that any number of
// any stream can be computed at once. It keeps no secrets: a player can find the key.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

namespace random_detail {

using Block = std::array<std::uint32_t, 4>;

/// Philox4x32-10 of a counter.
[[nodiscard]] constexpr Block philox(Block counter, std::uint64_t key) {
  auto low = static_cast<std::uint32_t>(key), high = static_cast<std::uint32_t>(key >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xd2511f53U} * counter[0];
    const std::uint64_t b = std::uint64_t{0xcd9e8d57U} * counter[2];
    counter = {
        static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ low, static_cast<std::uint32_t>(b),
        static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ high, static_cast<std::uint32_t>(a)};
    low += 0x9e3779b9U;
    high += 0xbb67ae85U;
  }
  return counter;
}

}  // namespace random_detail

/// A stream of random numbers. Its state is `key` and `drawn`: a game saves and hashes both, or
/// derives the stream again each tick, `Random(seed).stream(tick)`, and saves nothing.
///
/// Draw one number a statement: in f(random.below(6), random.below(6)) the compiler chooses which
/// comes first, and peers built by different compilers part.
struct Random {
  std::uint64_t key = 0;    ///< names the stream
  std::uint64_t drawn = 0;  ///< blocks drawn so far; any value is valid

  constexpr Random() = default;

  /// Any seed is a good one.
  explicit constexpr Random(std::uint64_t seed) : key(seed) {}

  friend constexpr bool operator==(const Random&, const Random&) = default;

  /// The stream of this one with that number: of a player, an object, a tick. It depends on `key`
  /// and the number alone, not on the draws so far, and is independent of this stream and of all
  /// others. Of n streams, two have the same key with a probability of n² / 2^65.
  [[nodiscard]] constexpr Random stream(std::uint64_t number) const {
    return Random(word(random_detail::philox(counter(number, k_streams), key)));
  }

  /// Uniform words. Every function below draws blocks of 128 bits, most of them one.
  constexpr std::uint64_t bits64() { return word(block()); }
  constexpr std::uint32_t bits32() { return block()[0]; }

  /// Uniform in 0 … bound − 1, without bias; bound > 0, else the result is 0.
  template <std::integral T>
  [[nodiscard]] T below(T bound) {
    LKS_ASSERT(bound > 0);
    return bound > 0 ? static_cast<T>(below_word(static_cast<std::uint64_t>(bound))) : T{};
  }

  /// Uniform in low … high, both included: between(1, 6). low ≤ high; T of 64 bits is signed.
  template <std::integral T>
  requires(sizeof(T) < 8 || std::signed_integral<T>) [[nodiscard]] T between(T low, T high) {
    return static_cast<T>(between_words(low, high));
  }

  /// The same of quantities, every value of the format as likely: between<Length>(2_m, 3_m).
  template <class T>
  requires(!std::integral<T>) [[nodiscard]] T
      between(std::type_identity_t<T> low, std::type_identity_t<T> high) {
    const std::int64_t raw = between_words(low.raw, high.raw);
    return T::from_raw(static_cast<typename T::Representation>(raw));
  }

  /// Uniform in [0, 1): every value of a plain number's format there is as likely.
  template <class T = Unit>
  requires(std::same_as<typename T::Unit, Scalar>) [[nodiscard]] constexpr T fraction() {
    static_assert(T::frac_bits > 0 && T::frac_bits < 64);
    return T::from_raw(static_cast<typename T::Representation>(bits64() >> (64 - T::frac_bits)));
  }

  /// Uniform on the unit sphere; each component is in error by less than 0.51 · 2^-30. Draws a
  /// block for each point of a cube until one lies in the ball (Donald Knuth, The Art of Computer
  /// Programming 2, 3.4.1): 1.91 on average.
  [[nodiscard]] Vec3<Unit> direction();

  /// Brings an array, a vector or a span into any of its orders, all as likely. (Richard
  /// Durstenfeld, "Algorithm 235: Random permutation", 1964.)
  template <class Items>
  void shuffle(Items&& items) {
    const std::span all(items);
    for (std::size_t left = all.size(); left > 1; --left) {
      using std::swap;
      swap(all[left - 1], all[below(left)]);
    }
  }

 private:
  static constexpr std::uint32_t k_draws = 0, k_streams = 1;  // counters of one never meet others

  static constexpr random_detail::Block counter(std::uint64_t number, std::uint32_t domain) {
    return {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), domain,
            0};
  }
  static constexpr std::uint64_t word(const random_detail::Block& block) {
    return block[0] | std::uint64_t{block[1]} << 32;
  }
  constexpr random_detail::Block block() {
    return random_detail::philox(counter(drawn++, k_draws), key);
  }

  std::uint64_t below_word(std::uint64_t bound);
  std::int64_t between_words(std::int64_t low, std::int64_t high);
};

/// Calls `f(name, field)` for each field of the state.
template <class R, class F>
requires(std::same_as<std::remove_const_t<R>, Random>) constexpr void visit_fields(R& random,
                                                                                   F&& f) {
  f("key", random.key);
  f("drawn", random.drawn);
}

}  // namespace lockstone
