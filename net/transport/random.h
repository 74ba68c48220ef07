// Random streams for the simulated network.
#pragma once

#include <cstdint>

namespace lockstone::net {

/// splitmix64 (Guy Steele, Doug Lea, Christine Flood, 2014): tiny, and any seed is a good one.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t bits = state_;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
    return bits ^ (bits >> 31);
  }

  /// Uniform in 0 … limit - 1, up to a bias of limit / 2^64; 0 for limit 0.
  std::uint64_t below(std::uint64_t limit) { return limit == 0 ? 0 : next() % limit; }

  /// True with a probability of `ppm` / 1'000'000. Always draws once, so that streams stay in step.
  bool chance(std::uint32_t ppm) { return below(1'000'000) < ppm; }

 private:
  std::uint64_t state_;
};

}  // namespace lockstone::net
