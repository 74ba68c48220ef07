// Runs random scenes and looks for violated invariants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lockstone::fuzz {

struct SceneFuzzOptions {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;  ///< index
  std::uint64_t count = 100;
  std::uint32_t ticks = 60;  ///< of each scene
  int threads = 1;
  bool with_rims = true;  ///< cylinders, cones and tapered capsules too
};

struct SceneFailure {
  std::uint64_t index = 0;
  std::uint64_t tick = 0;
  std::string what;
};

struct SceneFuzzReport {
  std::uint64_t scenes = 0;
  std::uint64_t ticks = 0;
  std::uint64_t contacts = 0;          ///< touching pairs, summed over the ticks
  std::uint64_t impacts = 0;           ///< of continuous collision
  std::uint64_t hits = 0;              ///< hit events
  std::uint64_t saturations = 0;       ///< values clamped
  std::uint64_t exhausted = 0;         ///< ticks in which pairs were left out
  std::vector<SceneFailure> failures;  ///< by index
};

/// Each scene runs twice: plainly, and on the other broad phase, without derived data, loaded from
/// canonical bytes of the first every few ticks. After every tick both hashes must be equal and
/// all events, and the contacts of a body; the state must be one that `load` lets in, and every
/// body within the world and its speed limit. Asserts and sanitizers see the rest. The same report
/// whatever the number of threads.
[[nodiscard]] SceneFuzzReport fuzz_scenes(const SceneFuzzOptions& options);

/// The scene that this thread is running: for a handler that reports a stopped program.
[[nodiscard]] std::uint64_t scene_at_hand();

}  // namespace lockstone::fuzz
