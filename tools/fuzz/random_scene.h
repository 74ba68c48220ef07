// Random worlds for the scene fuzzer: extreme sizes, masses and speeds, deep overlaps,
// contradicting joints, exhausted stores, and random commands on top.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <lockstone/world.h>

#include "tools/arena/integers.h"

namespace lockstone::fuzz {

/// A definition and the first state of its world: a function of seed and index alone, of integers
/// alone, so that every machine makes the same.
class RandomScene {
 public:
  /// `with_rims`: cylinders and cones too.
  RandomScene(std::uint64_t seed, std::uint64_t index, bool with_rims = true);

  /// A world as it begins, on the broad phase given.
  [[nodiscard]] World make(BroadPhaseKind broad_phase) const;

  /// The commands before tick `tick` of a world as it stands then. A world may refuse some of them.
  void drive(World& world) const;

  /// Its special features, for people.
  [[nodiscard]] std::string text() const;

 private:
  WorldDef def_;
  std::shared_ptr<const AssetSet> assets_;
  std::uint64_t seed_;
  bool with_rims_;
};

/// Once in so many times.
[[nodiscard]] inline bool chance(arena::Random& random, std::uint32_t one_in) {
  return random.below(one_in) == 0;
}

/// Null when it hits an empty slot.
[[nodiscard]] inline BodyHandle any_body(const World& world, arena::Random& random) {
  return world.body_limit() == 0 ? BodyHandle{} : world.body_at(random.below(world.body_limit()));
}

/// A command for a world as it stands, from sensible to absurd. The world may refuse it.
/// Which lists of events of the last step differ; empty when none do.
[[nodiscard]] std::string difference_of_events(const World& a, const World& b);

/// Gives bodies other event settings: all before the first tick, one of them seldom later. The
/// settings change no motion, and their numbers are drawn apart: scenes of one seed move alike
/// with and without them.
void drive_events(World& world, std::uint64_t seed);

[[nodiscard]] Command random_command(const World& world, arena::Random& random);

}  // namespace lockstone::fuzz
