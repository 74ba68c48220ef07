// Where contacts begin to touch, where they come to rest, and the constants of their iterations.
#pragma once

#include <cstdint>

#include "core/dynamics/state/time_step.h"
#include "core/geometry/distance/manifold.h"
#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

/// Points nearer than k_contact_slop count as touching, and come to rest at k_resting_overlap. In
/// between, a spring both pushes and lets go smoothly, so that bodies that rock by a hair do not
/// rattle.
inline constexpr Displacement k_contact_slop = Displacement::from_ratio(1, 4000);
inline constexpr Displacement k_resting_overlap = Displacement::from_ratio(1, 200000);
static_assert(k_resting_overlap < k_contact_slop);

/// Whether any point of a manifold touches.
[[nodiscard]] bool is_touching(const Manifold& manifold);

/// Constants of the iterations, for a world.
[[nodiscard]] lanes::SolverParams solver_params(const TimeStep& step);

/// Limits of friction are few steps of their format high: rounded alike in all substeps they would
/// err the same way for as long as something slides. Two sequences that fill the unit interval
/// evenly (van der Corput's, and multiples of the golden ratio) round them in turns instead.
[[nodiscard]] lanes::SolverParams dithered(lanes::SolverParams params, std::uint32_t substep);

}  // namespace lockstone
