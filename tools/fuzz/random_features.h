// Random settings of the features of worlds, for the scene fuzzer. Each draws its numbers apart
// from the others, so that scenes of one seed stay alike when a feature is added.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/world.h>

#include "tools/arena/integers.h"

namespace lockstone::fuzz {

/// Once in so many times.
[[nodiscard]] inline bool chance(arena::Random& random, std::uint32_t one_in) {
  return random.below(one_in) == 0;
}

/// Null when it hits an empty slot.
[[nodiscard]] inline BodyHandle any_body(const World& world, arena::Random& random) {
  return world.body_limit() == 0 ? BodyHandle{} : world.body_at(random.below(world.body_limit()));
}

/// Null when it hits an empty slot.
[[nodiscard]] inline JointHandle any_joint(const World& world, arena::Random& random) {
  return world.joint_limit() == 0 ? JointHandle{}
                                  : world.joint_at(random.below(world.joint_limit()));
}

/// Within `low` … `high`, both above 0, about as often in every octave.
[[nodiscard]] std::int64_t log_between(arena::Random& random, std::int64_t low, std::int64_t high);

/// Gives bodies other event settings: all before the first tick, one of them seldom later. The
/// settings change no motion, and their numbers are drawn apart: scenes of one seed move alike
/// with and without them.
void drive_events(World& world, std::uint64_t seed);

/// The path of a scene of this seed, drawn apart.
[[nodiscard]] AssetPtr random_path(std::uint64_t seed);

/// The floor of panels that some scenes have.
[[nodiscard]] AssetPtr random_panels();

/// The level that some scenes have: a compound of that floor, a bowl and a box.
[[nodiscard]] AssetPtr random_level();

/// Changes of bodies, fluids, rules, vehicles, locks of joints, ratchets, path joints, terrain and
/// groups of meshes, now and then, and of events as above. The world may refuse some.
void drive_features(World& world, std::uint64_t seed);

}  // namespace lockstone::fuzz
