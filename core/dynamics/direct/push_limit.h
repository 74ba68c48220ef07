// Limits the energy that an island gains where contacts push overlap out.
//
// Overlap goes at a bounded speed, but bodies that overlap in several places at once, as thin
// plates do once they have passed each other, may have to move a hundred times as fast for it. So
// all bodies of an island together gain no more energy than they have at four times the speed of
// the fastest push. Where they would, all pushes become slower by the same factor: a stack that
// has sunk in all of its contacts rises more slowly.
#pragma once

#include "core/dynamics/direct/island_pool.h"

namespace lockstone {

/// After the first phase of a substep was solved: whether the island gained too much by it. Then
/// the biases of overlaps are less, and the phase must be solved again.
[[nodiscard]] bool limits_pushes(const ContactRun& run, const IslandView& island);

}  // namespace lockstone
