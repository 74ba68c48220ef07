// From manifolds to constraints, once a tick.
#pragma once

#include <lockstone/asset.h>

#include "core/dynamics/body_record.h"
#include "core/dynamics/contact_constraint.h"
#include "core/dynamics/contact_record.h"
#include "core/dynamics/surface.h"
#include "core/dynamics/time_step.h"

namespace lockstone {

/// Softness of contacts, fixed for a world: against an immovable body twice as stiff.
struct ContactSoftness {
  Softness between_moving;
  Softness against_immovable;

  [[nodiscard]] static ContactSoftness of(const TimeStep& step);
};

/// Everything that one constraint is made of. The record gives the impulses to start from.
struct ContactInput {
  const BodyRecord& body_a;
  const BodyRecord& body_b;
  const SolverBody& solver_a;
  const SolverBody& solver_b;
  const Manifold& manifold;
  const ContactRecord& record;
  const SurfacePair& surfaces;
};

/// Fills `constraint` but its body and record indices. Answers how many values were clamped.
int prepare_contact(const ContactInput& input, const ContactSoftness& softness,
                    ContactConstraint& constraint);

}  // namespace lockstone
