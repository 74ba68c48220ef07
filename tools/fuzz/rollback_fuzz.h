// Rolls random worlds back at random, and compares with worlds that never roll back.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lockstone::fuzz {

struct RollbackFuzzOptions {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;  ///< index
  std::uint64_t count = 100;
  std::uint32_t rounds = 100;  ///< rollbacks of each world
  int threads = 1;
};

struct RollbackFailure {
  std::uint64_t index = 0;
  std::uint64_t tick = 0;
  std::string what;
};

struct RollbackFuzzReport {
  std::uint64_t worlds = 0;
  std::uint64_t rollbacks = 0;
  std::uint64_t ticks = 0;             ///< stepped with a history
  std::uint64_t computed_islands = 0;  ///< summed over the ticks
  std::uint64_t recalled_islands = 0;
  std::uint64_t partial_ticks = 0;        ///< in which some were computed and some recalled
  std::uint64_t whole_ticks = 0;          ///< in which all were recalled
  std::vector<RollbackFailure> failures;  ///< by index
};

/// Each world is stepped with a history on guesses, goes back, and is stepped on the true commands,
/// over and over; a second world only takes the true ones. After every true tick states, hashes and
/// events must be equal. Even indices are yards (random_yard.h), odd ones scenes of extremes
/// (random_scene.h). The same report whatever the number of threads.
[[nodiscard]] RollbackFuzzReport fuzz_rollbacks(const RollbackFuzzOptions& options);

}  // namespace lockstone::fuzz
