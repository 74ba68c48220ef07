// Keeps the centre of a thin body on the front side of one-sided triangles, so that they still meet
// it.
#pragma once

#include "core/world/data/world_data.h"
#include "core/world/phases/motion/moved_bodies.h"

namespace lockstone {

/// Moves each thin body that passed a front back before it.
void clamp_to_fronts(WorldData& world, const MovedBodies& moved);

}  // namespace lockstone
