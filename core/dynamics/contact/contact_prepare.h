// From manifolds to the inputs of the kernels that prepare constraints, once a tick.
#pragma once

#include <cstddef>

#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/surface.h"
#include "core/dynamics/state/time_step.h"
#include "core/geometry/distance/manifold.h"
#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

/// Stiffness of a soft constraint: E. Catto, "Solver2D", 2024, and "Soft Constraints", GDC 2011.
struct Softness {
  std::int32_t bias_rate = 0;   // 1/s, Q20
  std::int32_t mass_scale = 0;  // Q30; also the share that an impulse keeps: 1 − impulse scale
};

/// Softness of contacts, fixed for a world: against an immovable body twice as stiff.
struct ContactSoftness {
  Softness between_moving;
  Softness against_immovable;

  [[nodiscard]] static ContactSoftness of(const TimeStep& step);
};

/// Everything that one constraint is made of. The record gives the impulses to start from.
struct ContactInput {
  const SolverBody& body_a;
  const SolverBody& body_b;
  const Manifold& manifold;
  const ContactRecord& record;
  const ContactSurface& surface;
  bool is_pinched = false;  ///< its island is
};

/// The manifold as lanes read it.
[[nodiscard]] const std::int32_t* geometry_of(const Manifold& manifold);

/// Fills the inputs of a constraint besides the geometry. Returns whether the record has the
/// manifold's points already, in their places.
bool fill_source(const ContactInput& input, const ContactSoftness& softness,
                 lanes::PrepareInput& out);

/// t·low + b·high of a lane's word, in world axes.
void across(const lanes::ManifoldBlock& block, std::size_t lane, std::int64_t word,
            Vec3<SolverVelocity>& out);

}  // namespace lockstone
