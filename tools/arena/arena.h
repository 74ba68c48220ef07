// Everything a running match consists of. The rules are functions on it.
#pragma once

#include <array>
#include <vector>

#include <lockstone/rollback_history.h>
#include <lockstone/world.h>

#include "tools/arena/config.h"
#include "tools/arena/state.h"

namespace lockstone::arena {

/// Handles that the construction fixed: they follow from the configuration and are not state.
struct Level {
  BodyHandle ferry{};  ///< null in a variant without machines
  BodyHandle bar{};
  BodyHandle buggy{};  ///< its chassis
  BodyHandle hill{};
  std::array<BodyHandle, 2> goals{};
  std::vector<BodyHandle> loose;  ///< never destroyed, only moved
};

struct Arena {
  ArenaConfig config;
  World world;
  Level level;
  GameState state;
  RollbackHistory history{world};  // steps the world
};

/// Ends a command whose status the rules do not need: it is the same on every peer, and a command
/// that fails changes nothing.
inline void order(World& world, const Command& command) {
  static_cast<void>(world.apply(command));
}

}  // namespace lockstone::arena
