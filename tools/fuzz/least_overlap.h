// The least overlap of two convex shapes by descent from many directions: an upper bound that asks
// nothing of the kernels.
#pragma once

#include <span>

#include "tools/fuzz/pair_source.h"

namespace lockstone::fuzz {

/// The least overlap along any direction that was tried: the `seeds`, the axes of both shapes and
/// their cross products, and 96 directions spread over the sphere; from the best six of these
/// downhill until steps of 1e-8 rad find nothing better. At least the depth; above it by less than
/// 1e-10 of the sizes where a descent ends in the right valley.
[[nodiscard]] double least_overlap(const Pair& pair, std::span<const Real3> seeds);

}  // namespace lockstone::fuzz
