// Random numbers for tests: the same in every run unless LOCKSTONE_TEST_SEED says otherwise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace lockstone::test {

/// The default seed of tests. Single tests run with further seeds: see listed_seeds.txt.
inline constexpr std::uint64_t k_listed_seed = 20261126;

/// The seed of this run: LOCKSTONE_TEST_SEED, or the listed one. The same for every test of the
/// process, and printed: by this line `tools/test.sh --explore` finds the tests that depend on the
/// seed.
inline std::uint64_t run_seed() {
  static const std::uint64_t seed = [] {
    const char* text = std::getenv("LOCKSTONE_TEST_SEED");
    const std::uint64_t value = text != nullptr ? std::strtoull(text, nullptr, 0) : k_listed_seed;
    std::printf("[ seed     ] LOCKSTONE_TEST_SEED=%llu\n", static_cast<unsigned long long>(value));
    std::fflush(stdout);  // before anything stops the program
    return value;
  }();
  return seed;
}

/// SplitMix64: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed = run_seed()) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, limit).
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(next() % limit); }

  /// Uniform in [low, high].
  std::int64_t between(std::int64_t low, std::int64_t high) {
    const auto span = static_cast<std::uint64_t>(high - low) + 1;
    return low + static_cast<std::int64_t>(span == 0 ? next() : next() % span);
  }

 private:
  std::uint64_t state_;
};

}  // namespace lockstone::test
