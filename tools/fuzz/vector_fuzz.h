// Steps random worlds with every kind of vectors, and compares their states.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lockstone::fuzz {

struct VectorFuzzOptions {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;  ///< index
  std::uint64_t count = 100;
  std::uint32_t ticks = 120;  ///< of each world
  int threads = 1;
};

struct VectorFailure {
  std::uint64_t index = 0;
  std::uint64_t tick = 0;
  std::string vectors;  ///< the kind that differs from `scalar`; empty: the kind chosen by default
  std::string what;
};

struct VectorFuzzReport {
  std::uint64_t worlds = 0;
  std::uint64_t ticks = 0;  ///< of all worlds, with one kind
  std::uint32_t kinds = 0;  ///< of vectors, compared with `scalar`; the choice by default is one
  /// Of the hashes of all worlds after every tick, in order: two machines that print the same
  /// digest for the same options held the same states.
  std::uint64_t digest = 0;
  std::vector<VectorFailure> failures;  ///< of each kind and world the first, by index
};

/// Each world (random_world.h) is stepped with every kind of vectors that this processor has, and
/// with the one chosen by default; after every tick the hash of the state must be that of `scalar`.
/// The same report whatever the number of threads. Forces kinds for the whole process, at the end
/// none.
[[nodiscard]] VectorFuzzReport fuzz_vectors(const VectorFuzzOptions& options);

}  // namespace lockstone::fuzz
