// The answer of one or two bodies to an impact within a tick.
#pragma once

#include <span>

#include <lockstone/asset.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/state/body_record.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// A body at an impact. Velocity and spin of `record` change; a body that is not dynamic is not
/// pushed.
struct ImpactBody {
  BodyRecord& record;
  const InverseInertia& inertia;
};

/// One contact between A and B at the moment of impact, friction and restitution already mixed.
struct ImpactContact {
  const Manifold& manifold;
  Coefficient friction{};
  Coefficient restitution{};
  Velocity threshold = Velocity::from_integer(1);  ///< slower approaches do not bounce
};

/// Impulses at the points of the manifold, one point after another, until they push apart: along
/// the normal at least `restitution` times the approach, across it within Coulomb's cone. Both
/// bodies get the same impulse, up to the rounding of each velocity. Returns the greatest approach
/// speed.
///
/// J. Guendelman, R. Bridson, R. Fedkiw, "Nonconvex rigid bodies with stacking", 2003, section 7,
/// for impulses ahead of contacts.
Velocity answer_impact(ImpactBody a, ImpactBody b, const ImpactContact& contact);

}  // namespace lockstone
