// The cost of a rollback by the part of the world that the wrong guess touched: ticks stepped
// again in full, and by a history that recalls the untouched islands.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lockstone/profile.h>

namespace lockstone::bench {

struct WrongGuessOptions {
  int ticks = 8;    ///< to go back
  int repeats = 9;  ///< timed, of each share; both ways in turns
  int settle = 60;  ///< ticks before
};

/// The least of the repeats, of this thread's own time, in microseconds: other programs only add to
/// it.
struct WrongGuess {
  double share = 0;           ///< of the islands that the true input pushes and the guess did not
  std::uint32_t touched = 0;  ///< islands
  double full_us = 0;         ///< all ticks
  double history_us = 0;
  std::uint64_t computed = 0;  ///< islands, summed over the ticks of one rollback
  std::uint64_t recalled = 0;
  std::uint64_t hash = 0;  ///< after the last tick
  bool are_equal = true;   ///< both ways came to the same hash, always

  [[nodiscard]] double ratio() const { return full_us == 0 ? 0 : history_us / full_us; }
};

struct WrongGuessReport {
  std::uint32_t bodies = 0;  ///< that move
  std::uint32_t islands = 0;
  std::size_t contacts = 0;
  double load_us = 0;  ///< back to the first tick
  double save_us = 0;  ///< of the state after a tick
  double hash_us = 0;  ///< of the state after a tick that all bodies moved in
  std::size_t snapshot_bytes = 0;
  std::array<double, k_step_stages> stage_us{};  ///< of one tick in full
  std::vector<WrongGuess> guesses;               ///< by share
};

[[nodiscard]] WrongGuessReport measure_wrong_guesses(const WrongGuessOptions& options);

}  // namespace lockstone::bench
