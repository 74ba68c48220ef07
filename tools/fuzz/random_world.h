// A random world of either kind: a yard (random_yard.h) or a scene of extremes (random_scene.h).
#pragma once

#include <cstdint>
#include <optional>

#include <lockstone/world.h>

#include "tools/arena/integers.h"
#include "tools/fuzz/random_scene.h"
#include "tools/fuzz/random_yard.h"

namespace lockstone::fuzz {

class RandomWorld {
 public:
  /// Even indices are yards, odd ones scenes of extremes.
  RandomWorld(std::uint64_t seed, std::uint64_t index) {
    if (index % 2 == 0)
      yard_.emplace(seed, index);
    else
      scene_.emplace(seed, index);
  }

  /// The world as it begins.
  [[nodiscard]] World make() const {
    return yard_ ? yard_->make() : scene_->make(BroadPhaseKind::tree);
  }
  /// Gives it the commands of its next tick.
  void drive(World& world) const { yard_ ? yard_->drive(world) : scene_->drive(world); }
  /// A command that a wrong guess may give.
  [[nodiscard]] Command other_command(const World& world, arena::Random& random) const {
    return yard_ ? RandomYard::push(world, random) : random_command(world, random);
  }

 private:
  std::optional<RandomYard> yard_;
  std::optional<RandomScene> scene_;
};

}  // namespace lockstone::fuzz
