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
  /// `with_rims`: cylinders, cones and tapered capsules too.
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

/// Which lists of events of the last step differ; empty when none do.
[[nodiscard]] std::string difference_of_events(const World& a, const World& b);

/// A command for a world as it stands, from sensible to absurd. The world may refuse it.
[[nodiscard]] Command random_command(const World& world, arena::Random& random);

}  // namespace lockstone::fuzz
