// Places in which shapes touch in special positions, which random places hardly ever meet.
#pragma once

#include "tools/fuzz/pair_source.h"

namespace lockstone::fuzz {

/// Turns and moves B: coaxial with A, across A's axis, nearly parallel to it, or with an outermost
/// point of B (an edge, a rim, an apex) on an outermost point or on a face of A; apart, touching or
/// overlapping by micrometres, or nested. The axes are those along y.
void place_specially(Dice& dice, Pair& pair);

}  // namespace lockstone::fuzz
