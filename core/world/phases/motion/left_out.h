// The bodies that the contact solver leaves out of a tick.
#pragma once

#include "core/world/phases/motion/bounces.h"
#include "core/world/phases/motion/pendulums.h"
#include "core/world/phases/motion/still_islands.h"

namespace lockstone {

struct LeftOut {
  /// No function but this allocates. All outlive this; `islands` is scratch that others may share.
  LeftOut(WorldData& world, TickContacts& found, MovedBodies& moved, Islands& islands)
      : bounces(world, found, moved, islands),
        pendulums(world, found),
        still(world, found, bounces, pendulums, islands) {}

  /// Once the contacts of the tick are found.
  void find() {
    bounces.find();
    pendulums.find();
    still.find();
  }

  Bounces bounces;
  Pendulums pendulums;
  StillIslands still;
};

}  // namespace lockstone
