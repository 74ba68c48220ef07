// Surfaces and planes of a body in real numbers.
#pragma once

#include "tools/fuzz/pair_source.h"

namespace lockstone::fuzz {

/// How far a point (from the body's centre, world axes) is outside the surface; inside, minus the
/// distance to the nearest face. A polytope is the space below all its faces, as they stand.
[[nodiscard]] double outside(const Body& body, const Real3& point);

/// How far a point is above the highest plane of a solid with faces on both sides; else as
/// `outside`. Rays meet a hull as the part of space below all its planes, which reaches beyond the
/// vertices of merged faces: at sharp edges by any multiple of their unevenness. They meet a box
/// between its planes along its axes, which are square to 2^-30: up to 1 um from the sum of its
/// half axes at 400 m.
[[nodiscard]] double above_planes(const Body& body, const Real3& point);

/// Whether a segment goes deeper than `depth` into the body; a flat body is only entered from the
/// front, and farther than `depth` from its rim.
[[nodiscard]] bool is_entered(const Body& body, const Real3& from, const Real3& way, double depth);

}  // namespace lockstone::fuzz
