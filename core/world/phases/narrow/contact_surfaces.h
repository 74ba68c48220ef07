// The combined surface of a contact's two sides.
#pragma once

#include "core/dynamics/contact/contact_prepare.h"
#include "core/world/data/world_data.h"

namespace lockstone {

/// Friction, restitution, rolling resistance and drive of a contact. `surface_a`, `surface_b`: of
/// the parts in contact; null: the body's own.
void find_surface(const WorldData& world, const Pair& pair, const Surface* surface_a,
                  const Surface* surface_b, const Manifold& manifold, ContactSurface& both);

}  // namespace lockstone
