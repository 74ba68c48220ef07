// Random yards for the rollback fuzzer: islands of many kinds, near enough to reach each other now
// and then.
#pragma once

#include <cstdint>

#include <lockstone/world.h>

#include "tools/arena/integers.h"

namespace lockstone::fuzz {

/// A yard is a function of seed and index alone, of integers alone.
class RandomYard {
 public:
  RandomYard(std::uint64_t seed, std::uint64_t index);

  [[nodiscard]] World make() const;

  /// The commands of a tick: mostly one body pushed, as by a player.
  void drive(World& world) const;

  /// A command that a wrong guess may give or leave out.
  [[nodiscard]] static Command push(const World& world, arena::Random& random);

 private:
  /// The vehicles of the yard get other controls, now and then.
  void drive_vehicles_on(World& world) const;

  std::uint64_t seed_;
};

}  // namespace lockstone::fuzz
